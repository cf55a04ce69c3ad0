// SPDX-License-Identifier: BSD-3-Clause
// rail_facets.hpp searches, for one sign of one sensing element, the plane (facet) at which the element's readings are
// saturated.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "rail_evidence.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"

namespace tumble::rails {

/// Gate is the condition for readings of a facet: not below `from` along `row`, and close to the extreme for cross-axis
/// sensitivities up to `steepest`.
struct Gate {
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double from = 0.0, steepest = 0.0, near_min = 0.0;
};

/// State of the search for one sign of one sensing element.
struct Side {
  int axis = 0, sign = 1;
  RailFacet facet;
  Gate gate;
  int samples = 0;
  double log_odds = -std::numeric_limits<double>::infinity();
};

struct FacetPrior {
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

inline Eigen::Vector2d others(const Eigen::Vector3d& y, int axis) {
  return {y[(axis + 1) % 3], y[(axis + 2) % 3]};
}

/// Returns the largest value of a reading along a row with cross-axis sensitivities up to `steepest`.
inline double highest_value(const Eigen::Vector3d& y, int axis, int sign, double steepest) {
  return sign * y[axis] + steepest * others(y, axis).lpNorm<1>();
}

/// Extreme describes one sign of an axis: its samples close to the extreme, and the slab for the search.
struct Extreme {
  int axis = 0, sign = 1;
  double slab = 0.0;
  double steepest = 0.0, near_min = 0.0;
};

/// Finds the readings close to the extreme, and stores their indices in the workspace. Cost: O(N). Returns nothing if
/// the readings of the axis are too small for saturation.
std::optional<Extreme> find_extreme(const RailPlaneFinder::Params& params, const DistinctReadings& readings, int axis,
                                    int sign, const FacetPrior& prior, double slope_range,
                                    RailPlaneFinder::Workspace& workspace);

/// Returns the cross-axis sensitivities, on a grid about the prior, whose slab contains the most samples of
/// find_extreme(). A penalty for unlikely cross-axis sensitivities is subtracted from the number of samples, see
/// rails.md (R57).
Eigen::Vector2d search_slopes(const DistinctReadings& readings, const Extreme& extreme, double slope_max,
                              const FacetPrior& prior, RailPlaneFinder::Workspace& workspace);

/// Fits the facet, starting from the cross-axis sensitivities `slopes`. The robust fit of rails.md (R58) starts with
/// the standard deviation `deviation`. The function stores the facet's samples in the workspace.
Side fit_facet(const DistinctReadings& readings, const Extreme& extreme, const FacetPrior& prior,
               const Eigen::Vector2d& slopes, double deviation, RailPlaneFinder::Workspace& workspace);

}  // namespace tumble::rails
