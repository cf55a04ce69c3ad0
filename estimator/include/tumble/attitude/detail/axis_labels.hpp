// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace tumble {

/// AxisLabels assigns the axes of an accelerometer to the axes of the gyro in the same IMU. While the body rotates, the
/// measured gravity rotates as the gyro predicts only if the axis labels are correct. The rotation of gravity cannot
/// reveal that all three axes of the accelerometer are flipped. AxisLabels describes only rotations by multiples of a
/// right angle.
struct AxisLabels {
  std::array<int, 3> axis = {0, 1, 2};              ///< index of the accelerometer reading along x, y, z of the gyro
  std::array<double, 3> axis_signs = {1., 1., 1.};  ///< sign of each axis; the first sign is 1
  bool all_rates_inverted = false;                  ///< all three rates are inverted

  /// Returns the specific force in the axes of the gyro.
  Eigen::Vector3d in_corrected_axes(const Eigen::Vector3d& force) const {
    return {axis_signs[0] * force[axis[0]], axis_signs[1] * force[axis[1]], axis_signs[2] * force[axis[2]]};
  }
};

inline constexpr int kAxisLabels = 48;

/// Index 0 is the identity.
const std::array<AxisLabels, kAxisLabels>& axis_labels();

}  // namespace tumble
