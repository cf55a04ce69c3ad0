// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "tracking.hpp"

/// Choice of the registration's starting poses, including all restarts.
namespace tumble::mapping {

struct Attempt {
  bool too_few_matches = false;  ///< reason without an alignment: too few map points
  int iterations = 0;
  double inlier_share = 0.0;  ///< fraction of the points of the last registration
};

/// Candidates for the start of a sweep.
struct SearchContext {
  const TrackingState& tracking;
  const Registration::Prior& prior;
  /// State by a relocalisation that the sweep contradicted, as a start of the search. Null if no relocalisation was
  /// contradicted.
  const MotionState* contradicted = nullptr;
};

/// Aligns a sweep by all means that its tracking state allows. `trajectory` is that of the alignment, or of a failed
/// attempt. `alignment` is that of the sweep's start, and is empty if no alignment was found.
Attempt attempt(const LidarInertialOdometry::Params& params, const SearchContext& from, const Scene& scene,
                Aligner& aligner, SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment);

/// Result of registering a sweep to the map.
struct Placed {
  SweepVerdict verdict = SweepVerdict::rejected;
  bool expected = true;  ///< the alignment agrees with the inertial prediction
  Placement placement = Placement::not_tried;
  bool map_too_sparse = false;                    ///< the sweep has points, but the map has too few nearby
  std::optional<Registration::Result> alignment;  ///< of its start
};

/// Sets the verdict of an attempt with `points` points. `placed` already contains the alignment and whether the
/// alignment was expected. If the map had too few points, or after enough failed searches, the motion continues by
/// inertial prediction as `degenerate`.
void judge(const LidarInertialOdometry::Params& params, const TrackingState& before, std::size_t points,
           bool prior_certain, const Attempt& attempt, Placed& placed);

/// Returns the number of the first displaced start of a search after `failed` failed searches, including the sweep whose
/// registration failed. The first search begins with start 1, and each search continues after the last one.
int next_start(int failed, int starts_per_search, const RelocalizationParams& params);

/// Computes start number `index` of a search. Start 0 is the prior. The further starts are shifts along each axis by
/// its uncertainty, closest first, mapping.md (R66).
void move_start(const RelocalizationParams& params, int index, Registration::Prior& prior);

}  // namespace tumble::mapping
