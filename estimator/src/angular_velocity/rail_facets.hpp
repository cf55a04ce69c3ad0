// SPDX-License-Identifier: BSD-3-Clause
// rail_facets.hpp fits a plane (facet) to the saturated readings of one sensing element and one sign.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "rail_evidence.hpp"
#include "tumble/angular_velocity/detail/rail_planes.hpp"

namespace tumble::rails {

/// Gate selects the readings near a saturation plane. Selected readings have a projection onto `row` of at least
/// `from`. The highest_value() of selected readings, for cross-axis sensitivities up to `steepest`, is at least
/// `near_min`.
struct Gate {
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double from = 0.0, steepest = 0.0, near_min = 0.0;
};

/// Side is the state of the search for the saturation plane of one sign of one sensing element.
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

/// Returns the largest projection of the reading `y` onto a sensing direction with cross-axis sensitivities up to
/// `steepest`.
inline double highest_value(const Eigen::Vector3d& y, int axis, int sign, double steepest) {
  return sign * y[axis] + steepest * others(y, axis).lpNorm<1>();
}

/// Extreme contains the samples close to the largest reading of an axis, for one sign.
struct Extreme {
  int axis = 0, sign = 1;
  double slab = 0.0;
  double steepest = 0.0, near_min = 0.0;
};

/// Finds the readings close to the axis' largest reading of one sign, and stores their indices in the workspace. Cost:
/// O(N). Returns nothing if the largest reading is too small for saturation.
std::optional<Extreme> find_extreme(const RailPlaneFinder::Params& params, const DistinctReadings& readings, int axis,
                                    int sign, const FacetPrior& prior, double slope_range,
                                    RailPlaneFinder::Workspace& workspace);

/// Searches a grid around the prior for the cross-axis sensitivities whose plane contains most readings of
/// find_extreme(). Unlikely cross-axis sensitivities are penalised, see rails.md (R57).
Eigen::Vector2d search_slopes(const DistinctReadings& readings, const Extreme& extreme, double slope_max,
                              const FacetPrior& prior, RailPlaneFinder::Workspace& workspace);

/// Fits the saturation plane, starting from the cross-axis sensitivities `slopes`: rails.md (R58). `deviation` is the
/// initial standard deviation of the residuals. The function stores the indices of the readings on the plane in the
/// workspace.
Side fit_facet(const DistinctReadings& readings, const Extreme& extreme, const FacetPrior& prior,
               const Eigen::Vector2d& slopes, double deviation, RailPlaneFinder::Workspace& workspace);

}  // namespace tumble::rails
