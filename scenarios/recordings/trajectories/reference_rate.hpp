// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// Angular rates from an optical reference's attitudes. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Half the window for differentiating attitudes, and its minimum number of steps. Of 10 to 70 ms, 20 ms gives the
/// smallest error at unclipped samples of three hand-held recordings of RepoIMU (median 0.05 to 0.12 rad/s).
inline constexpr std::int64_t kRateWindow_ns = 20'000'000;
inline constexpr double kRateSteps = 2.0;

/// Returns the body rate in body axes at each of `times_ns`, which must not decrease. Fits a parabola to the rotation
/// vectors, relative to the nearest attitude, of all poses in the window (at least two median steps). The rate is its
/// slope. NaN if the window has a gap (2.5 median steps), fewer than three poses, or none on one side. A third
/// derivative j of the angle gives a bias of about j h^2 / 10 for a window +-h: 1.4 % at 20 ms and 3 Hz. O(N).
std::vector<Eigen::Vector3d> reference_rates(const std::vector<ReferencePose>& poses,
                                             std::span<const std::int64_t> times_ns);

}  // namespace tumble::scenarios
