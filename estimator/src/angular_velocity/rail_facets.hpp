// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "rail_evidence.hpp"
#include "tumble/angular_velocity/detail/rail_planes.hpp"

namespace tumble::rails {

struct Gate {
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double from = 0.0, steepest = 0.0, near_min = 0.0;
};

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

struct Extreme {
  int axis = 0, sign = 1;
  double slab = 0.0;
  double steepest = 0.0, near_min = 0.0;
};

/// Returns nothing if the largest reading of the axis is too small for saturation. Cost: O(N).
std::optional<Extreme> find_extreme(const RailPlaneFinder::Params& params, const DistinctReadings& readings, int axis,
                                    int sign, const FacetPrior& prior, double slope_range,
                                    RailPlaneFinder::Workspace& workspace);

/// Returns the cross-axis sensitivities of the plane that has the most readings closely below it: rails.md (R57).
Eigen::Vector2d search_slopes(const DistinctReadings& readings, const Extreme& extreme, double slope_max,
                              const FacetPrior& prior, RailPlaneFinder::Workspace& workspace);

/// Fits a plane to the saturated readings, starting from the cross-axis sensitivities `slopes`: rails.md (R58).
Side fit_facet(const DistinctReadings& readings, const Extreme& extreme, const FacetPrior& prior,
               const Eigen::Vector2d& slopes, double deviation, RailPlaneFinder::Workspace& workspace);

}  // namespace tumble::rails
