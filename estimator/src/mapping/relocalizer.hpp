// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "tracking.hpp"

/// relocalizer.hpp chooses the starting poses of a registration, including all restarts.
namespace tumble::mapping {

struct Attempt {
  bool too_few_matches = false;  ///< whether an alignment failed because of too few map points
  int iterations = 0;
  double inlier_ratio = 0.0;  ///< inlier fraction of the last registration
};

/// SearchContext contains the candidates for the start of a sweep.
struct SearchContext {
  const TrackingState& tracking;
  const Registration::Prior& prior;
  /// State according to a relocalisation that the sweep contradicted, as a start of the search. The pointer is null if
  /// no relocalisation was contradicted.
  const MotionState* contradicted = nullptr;
};

/// Aligns a sweep by all methods that its tracking state allows. `trajectory` is that of the alignment, or of a failed
/// attempt. `alignment` refers to the start of the sweep, and is empty if no alignment was found.
Attempt attempt(const LidarInertialOdometry::Params& params, const SearchContext& from, const Scene& scene,
                Aligner& aligner, SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment);

/// Placed is the result of registering a sweep to the map.
struct Placed {
  SweepVerdict verdict = SweepVerdict::rejected;
  bool expected = true;  ///< the alignment agrees with the inertial prediction
  RegistrationOutcome placement = RegistrationOutcome::not_tried;
  bool map_too_sparse = false;                    ///< the sweep has points, but the map has too few nearby points
  std::optional<Registration::Result> alignment;  ///< alignment at the start of the sweep
};

/// Sets the verdict of an attempt with `points` points. `placed` must contain the alignment, and whether the alignment
/// was expected. If the map has too few points, or after enough failed searches, the motion continues by inertial
/// prediction with the verdict `degenerate`.
void judge(const LidarInertialOdometry::Params& params, const TrackingState& before, std::size_t points,
           bool prior_certain, const Attempt& attempt, Placed& placed);

/// Computes start number `index` of a search. Start 0 is the prior. The further starts are shifts along each axis by
/// its uncertainty, closest first, mapping.md (R66).
void move_start(const RelocalisationParams& params, int index, Registration::Prior& prior);

}  // namespace tumble::mapping
