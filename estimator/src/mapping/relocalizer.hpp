// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "tracking.hpp"

namespace tumble::mapping {

struct Attempt {
  bool too_few_matches = false;  ///< an alignment failed because the map has too few points
  int iterations = 0;
  double inlier_ratio = 0.0;  ///< inlier fraction of the last registration
};

/// SearchContext contains the possible states at the start of a sweep, from which the search chooses initial poses.
struct SearchContext {
  const TrackingState& tracking;
  const Registration::Prior& prior;
  /// state of a relocalisation that later sweeps contradicted, as an additional starting pose; or null
  const MotionState* contradicted = nullptr;
};

/// `trajectory` receives the registered motion, or the last motion of a failed registration. `alignment` is empty if no
/// registration succeeded.
Attempt attempt(const LidarInertialOdometry::Params& params, const SearchContext& from, const Scene& scene,
                Aligner& aligner, SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment);

struct Placed {
  SweepVerdict verdict = SweepVerdict::rejected;
  bool expected = true;  ///< the registered pose agrees with the inertial prediction
  RegistrationOutcome placement = RegistrationOutcome::not_tried;
  bool map_too_sparse = false;                    ///< the sweep has points, but the map has too few nearby points
  std::optional<Registration::Result> alignment;  ///< alignment at the start of the sweep
};

/// The verdict is `degenerate` if the map has too few points, or after enough failed searches.
void judge(const LidarInertialOdometry::Params& params, const TrackingState& before, std::size_t points,
           bool prior_certain, const Attempt& attempt, Placed& placed);

/// Initial pose number 0 is the predicted pose; all others are shifted or rotated along one axis, closest first:
/// mapping.md (R66).
void move_start(int index, Registration::Prior& prior);

}  // namespace tumble::mapping
