// SPDX-License-Identifier: BSD-3-Clause
// The search for the facet of one sign of one element: the plane at which its readings stand.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "rail_evidence.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"

namespace tumble::rails {

/// Readings that belong to a facet: along `row` not below `from`, and near the extreme for slopes up to `steepest`.
struct Gate {
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double from = 0.0, steepest = 0.0, near_from = 0.0;
};

/// One sign of one element while it is searched for.
struct Side {
  int axis = 0, sign = 1;
  RailFacet facet;
  Gate gate;  ///< of the facet's readings
  int samples = 0;
  double log_odds = -std::numeric_limits<double>::infinity();
};

/// What is known of a facet before its samples are looked at.
struct FacetPrior {
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

/// The two axes beside.
inline Eigen::Vector2d others(const Eigen::Vector3d& y, int axis) {
  return {y[(axis + 1) % 3], y[(axis + 2) % 3]};
}

/// The most that a reading may be worth along a row with slopes up to `steepest`.
inline double highest_value(const Eigen::Vector3d& y, int axis, int sign, double steepest) {
  return sign * y[axis] + steepest * others(y, axis).lpNorm<1>();
}

/// One sign of an axis, its samples near the extreme and the slab in which a rail is looked for.
struct Extreme {
  int axis = 0, sign = 1;
  double slab = 0.0;
  double steepest = 0.0, near_from = 0.0;
};

/// Nothing where the axis reads too little for a rail. Leaves the samples near it in the workspace. O(N).
std::optional<Extreme> find_extreme(const RailPlaneFinder::Params& params, const DistinctReadings& readings, int axis,
                                    int sign, const FacetPrior& prior, double slope_range,
                                    RailPlaneFinder::Workspace& workspace);

/// Slopes on a grid about the prior whose slab holds the most of the samples that find_extreme() left, less what is odd
/// about them: rails.md (R57).
Eigen::Vector2d search_slopes(const DistinctReadings& readings, const Extreme& extreme, double slope_max,
                              const FacetPrior& prior, RailPlaneFinder::Workspace& workspace);

/// The facet about given slopes, the robust fit (rails.md (R58)) starting with `deviation`. Leaves its samples in the
/// workspace.
Side fit_facet(const DistinctReadings& readings, const Extreme& extreme, const FacetPrior& prior,
               const Eigen::Vector2d& slopes, double deviation, RailPlaneFinder::Workspace& workspace);

}  // namespace tumble::rails
