// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace tumble {

/// A labelling of an accelerometer's axes relative to the axes of the IMU's gyro.
///
/// A file from another source may use other axis names, or z down. The rotation of gravity distinguishes 24 labellings.
/// A flip of all three axes is not distinguished because flipped axes rotate like the unflipped ones. An inverted gyro
/// doubles the number of labellings. Rotations of less than a right angle are not included.
struct AxisLabels {
  std::array<int, 3> axis = {0, 1, 2};        ///< index of the reading that is the x, y, z of the gyro's axes
  std::array<double, 3> sign = {1., 1., 1.};  ///< sign of each axis; the first sign is 1
  bool gyro_flipped = false;                  ///< all three rates are inverted

  /// Returns the force in the gyro's axes.
  Eigen::Vector3d renamed(const Eigen::Vector3d& force) const {
    return {sign[0] * force[axis[0]], sign[1] * force[axis[1]], sign[2] * force[axis[2]]};
  }
};

inline constexpr int kAxisLabels = 48;

/// Returns all labellings. The entry at index 0 is the identity.
const std::array<AxisLabels, kAxisLabels>& axis_labels();

}  // namespace tumble
