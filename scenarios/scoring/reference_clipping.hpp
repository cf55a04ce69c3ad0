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
/// A candidate is a sample within 5 % of the extreme reading of the axis and sign. The reference confirms a candidate
/// if the reference rate exceeds the reading by more than 2 %, and by four times the median difference between reading
/// and reference. A saturation limit exists if at least five candidates, and at least half of the candidates, are
/// confirmed.
///
/// The saturation plane is the least-squares fit to the confirmed samples, with a prior of 0 +- 0.03 for the cross-axis
/// sensitivities and a residual deviation of 0.02 rad/s. A second fit uses only samples within 2 % of the first
/// saturation plane.
std::array<ReferenceRail, 6> reference_rails(std::span<const Eigen::Vector3d> reading,
                                             std::span<const Eigen::Vector3d> reference);

std::vector<std::uint8_t> clipped_by_reference(std::span<const Eigen::Vector3d> reading,
                                               std::span<const Eigen::Vector3d> reference);

}  // namespace tumble::scenarios
