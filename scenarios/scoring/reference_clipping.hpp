// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// ReferenceRail is the saturation limit of gyro axis j with sign s (+1 or -1). While axis j is saturated, the readings
/// y are on the plane s y_j = rail + slopes * (readings of the other two axes, in order).
struct ReferenceRail {
  bool found = false;
  double rail_rad_s = 0.0;
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
};

/// Estimates the saturation plane of each gyro axis and sign from a reference rate. The estimator under test does not
/// influence the saturation planes.
///
/// A gyro reading may be saturated if it is within 5 % of the largest reading of the same axis and sign. The reference
/// confirms the saturation of a reading if the reference rate clearly exceeds the reading. The reference rate must
/// exceed the reading by more than 2 % of the largest reading, and by more than four times the median difference
/// between gyro and reference. A saturation limit exists if the reference confirms the saturation of at least five
/// readings and of at least half of the possibly saturated readings.
///
/// The saturation plane is fitted by least squares to the readings whose saturation the reference confirms. The slopes
/// of the plane have the prior 0 +- 0.03, and the readings are assumed to scatter by 0.02 rad/s about the plane. A
/// second fit of the plane uses only the readings within 2 % of the first plane.
std::array<ReferenceRail, 6> reference_rails(std::span<const Eigen::Vector3d> reading,
                                             std::span<const Eigen::Vector3d> reference);

std::vector<std::uint8_t> clipped_by_reference(std::span<const Eigen::Vector3d> reading,
                                               std::span<const Eigen::Vector3d> reference);

}  // namespace tumble::scenarios
