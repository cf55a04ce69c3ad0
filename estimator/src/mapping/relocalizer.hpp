// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "tracking.hpp"

/// relocalizer.hpp chooses the initial poses of a registration, including all restarts.
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
  /// State according to a contradicted relocalisation, as an initial pose of the search; otherwise null.
  const MotionState* contradicted = nullptr;
};

/// Registers a sweep to the map, by tracking or by a search of initial poses, depending on the tracking state.
/// `trajectory` is the registered motion, or the motion of a failed attempt. `alignment` is the registration at the
/// start of the sweep, and empty if no registration succeeded.
Attempt attempt(const LidarInertialOdometry::Params& params, const SearchContext& from, const Scene& scene,
                Aligner& aligner, SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment);

/// Placed is the result of registering one sweep to the map.
struct Placed {
  SweepVerdict verdict = SweepVerdict::rejected;
  bool expected = true;  ///< the registered pose agrees with the inertial prediction
  RegistrationOutcome placement = RegistrationOutcome::not_tried;
  bool map_too_sparse = false;                    ///< the sweep has points, but the map has too few nearby points
  std::optional<Registration::Result> alignment;  ///< alignment at the start of the sweep
};

/// Sets the verdict of `placed`, the result of registering a sweep with `points` points. `placed` must contain the
/// registration, and whether it agrees with the prediction. The verdict is `degenerate`, and the inertial prediction
/// continues the motion, if the map has too few points or after enough failed searches.
void judge(const LidarInertialOdometry::Params& params, const TrackingState& before, std::size_t points,
           bool prior_certain, const Attempt& attempt, Placed& placed);

/// Computes the initial pose number `index` of a search. Number 0 is the predicted pose. All other poses are shifted or
/// rotated along one axis, closest first: mapping.md (R66).
void move_start(const RelocalisationParams& params, int index, Registration::Prior& prior);

}  // namespace tumble::mapping
