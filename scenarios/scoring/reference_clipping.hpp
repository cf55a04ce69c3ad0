// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// ReferenceRail is the saturation limit of gyro axis j with sign s (+1 or -1). The limit is tilted: while axis j is
/// saturated, the readings y are on the plane s y_j = rail + slopes * (readings of the other two axes, in order).
struct ReferenceRail {
  bool found = false;
  double rail_rad_s = 0.0;
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
};

/// Estimates the saturation plane of each gyro axis and sign from a reference rate. The estimator under test has no
/// influence on the result.
///
/// Gyro readings within 5 % of the largest reading of their axis and sign may be saturated. The reference confirms the
/// saturation if the reference rate exceeds the gyro reading by 2 % of the largest reading, and by four times the
/// median difference between gyro and reference. A saturation limit exists if both conditions are met: the reference
/// confirms at least five readings, and the reference confirms at least half of the possibly saturated readings.
///
/// A plane is fitted to the confirmed readings by least squares. The prior of the slopes is 0 +- 0.03, and the readings
/// are assumed to scatter by 0.02 rad/s. The plane is fitted again to the readings within 2 % of the plane.
std::array<ReferenceRail, 6> reference_rails(std::span<const Eigen::Vector3d> reading,
                                             std::span<const Eigen::Vector3d> reference);

std::vector<std::uint8_t> clipped_by_reference(std::span<const Eigen::Vector3d> reading,
                                               std::span<const Eigen::Vector3d> reference);

}  // namespace tumble::scenarios
