// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "tracking.hpp"

/// Where the registration is to begin: owns all restarts.
namespace tumble::mapping {

struct Attempt {
  bool too_few_matches = false;  ///< why there is none: the map had nothing to say
  int iterations = 0;
  double inlier_share = 0.0;  ///< of the points of the last registration
};

/// Where a sweep may have begun.
struct Whereabouts {
  const TrackingState& tracking;
  const Registration::Prior& prior;
  /// By a place that this sweep has contradicted: a little off it is one to search from. Null: none.
  const MotionState* contradicted = nullptr;
};

/// Aligns a sweep by all means that its tracking state allows. `trajectory` is the alignment's, or one that was tried;
/// `alignment` is that of the sweep's start, empty where none was found.
Attempt attempt(const LidarInertialOdometry::Params& params, const Whereabouts& from, const Scene& scene,
                Aligner& aligner, SweepTrajectory& trajectory, std::optional<Registration::Result>& alignment);

/// How a sweep lies in the map.
struct Placed {
  SweepVerdict verdict = SweepVerdict::rejected;
  bool expected = true;  ///< of the alignment: where the sweeps before lead to
  Placement placement = Placement::not_tried;
  bool map_says_nothing = false;                  ///< the sweep has points, but the map too few of them
  std::optional<Registration::Result> alignment;  ///< of its start
};

/// What an attempt with so many points comes to, whose alignment, and whether that was expected, `placed` has already.
/// Where the map had nothing to say, or after enough searches in vain, the motion goes on by inertia as `degenerate`.
void judge(const LidarInertialOdometry::Params& params, const TrackingState& before, std::size_t points,
           bool prior_trusted, const Attempt& attempt, Placed& placed);

/// Start number `index` of a search: the prior itself, then moved along each axis by what it may be off by, nearer ones
/// first, mapping.md (R54).
void move_start(const RelocalizationParams& params, int index, Registration::Prior& prior);

}  // namespace tumble::mapping
