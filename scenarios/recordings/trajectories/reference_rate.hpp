// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// Rates from an optical reference's attitudes. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Half the window over which attitudes are differentiated, and the least number of steps in it. 20 ms: of 10 to 70 ms
/// the one with which the reference of three hand-held recordings of RepoIMU errs least at unclipped samples (median
/// 0.05 to 0.12 rad/s).
inline constexpr std::int64_t kRateWindow_ns = 20'000'000;
inline constexpr double kRateSteps = 2.0;

/// The body's rate in its own axes at each instant of `times_ns`, which must not fall: the slope there of the parabola
/// through the rotation vectors, seen from the attitude nearest to the instant, of all poses within the window (two
/// median steps where those are longer). NaN where the window holds a gap (2.5 median steps), fewer than three poses,
/// or none on either side. A third derivative j of the angle biases it by j h^2 / 10 or so over a window +-h: at 20 ms
/// and 3 Hz by 1.4 %. O(N).
std::vector<Eigen::Vector3d> reference_rates(const std::vector<ReferencePose>& poses,
                                             std::span<const std::int64_t> times_ns);

}  // namespace tumble::scenarios
