// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// reference_rates computes angular rates from the attitudes of an optical reference.
namespace tumble::scenarios {

/// Half of the time window for differentiating attitudes, and its minimum in steps. Among windows of 10 to 70 ms, 20 ms
/// gives the smallest error at unclipped samples of three hand-held recordings of RepoIMU (median 0.05 to 0.12 rad/s).
inline constexpr std::int64_t kRateWindow_ns = 20'000'000;
inline constexpr double kRateSteps = 2.0;

/// Estimates the angular rate of the body, in body axes, at each of `times_ns`, which must not decrease. A parabola is
/// fitted to the rotation vectors of all poses in the window (at least two median steps), relative to the nearest
/// attitude. The rate is its derivative at the requested time. The rate is NaN if the window has a gap (2.5 median
/// steps), fewer than three poses, or no pose on one side. If the angle has a third derivative j, a window of +-h gives
/// a bias of about j h^2 / 10: 1.4 % at 20 ms and 3 Hz. The cost is O(N).
std::vector<Eigen::Vector3d> reference_rates(const std::vector<ReferencePose>& poses,
                                             std::span<const std::int64_t> times_ns);

}  // namespace tumble::scenarios
