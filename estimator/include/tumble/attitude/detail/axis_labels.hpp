// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace tumble {

/// One way in which the axes of an accelerometer can be named and signed beside those of the gyro of the same IMU.
///
/// A file that somebody else made may call y what the gyro's axes call x, or point z down. Gravity's turning tells the
/// 24 namings up to a flip of all three axes, which turns as they do; a gyro of the wrong sense makes them twice as
/// many. Not among them: axes that are turned by less than a right angle.
struct AxisLabels {
  std::array<int, 3> axis = {0, 1, 2};        ///< which reading is the x, y, z of the gyro's axes
  std::array<double, 3> sign = {1., 1., 1.};  ///< and with which sign; the first is 1
  bool gyro_flipped = false;                  ///< all three rates of the other sense

  /// Force in the gyro's axes.
  Eigen::Vector3d renamed(const Eigen::Vector3d& force) const {
    return {sign[0] * force[axis[0]], sign[1] * force[axis[1]], sign[2] * force[axis[2]]};
  }
};

inline constexpr int kAxisLabels = 48;

/// All of them; the first: as they are named.
const std::array<AxisLabels, kAxisLabels>& axis_labels();

}  // namespace tumble
