// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// ReferenceRail is the saturation limit of axis j with sign s, a tilted plane of readings: s y_j = rail + slopes *
/// (the other two axes, in order).
struct ReferenceRail {
  bool found = false;
  double rail_rad_s = 0.0;
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
};

/// Estimates the saturation planes of the three axes for both signs from a reference of the rate, independently of the
/// estimator.
///
/// Gyro readings within 5 % of the largest reading of their axis and sign may be saturated. The reference confirms the
/// saturation if the reference rate exceeds the gyro reading by 2 % of the largest reading, and by four times the
/// median difference between gyro and reference. A saturation limit exists if five readings, and half of the possibly
/// saturated readings, are confirmed.
///
/// A least-squares fit to the confirmed readings gives the saturation plane. The fit assumes slopes of 0 +- 0.03, and
/// readings that scatter by 0.02 rad/s. The fit is repeated with the readings within 2 % of the saturation plane.
std::array<ReferenceRail, 6> reference_rails(std::span<const Eigen::Vector3d> reading,
                                             std::span<const Eigen::Vector3d> reference);

std::vector<std::uint8_t> clipped_by_reference(std::span<const Eigen::Vector3d> reading,
                                               std::span<const Eigen::Vector3d> reference);

}  // namespace tumble::scenarios
