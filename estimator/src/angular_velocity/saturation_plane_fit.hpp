// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "saturation_plane_evidence.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

namespace tumble::rails {

struct PlaneInlierGate {
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double from = 0.0, max_cross_axis_slope = 0.0, near_readings_min = 0.0;
};

struct SaturationPlaneSide {
  int axis = 0, side = 1;
  SaturationPlaneCandidate plane;
  PlaneInlierGate gate;
  int samples = 0;
  double log_odds = -std::numeric_limits<double>::infinity();
};

struct PlaneSlopePrior {
  Eigen::Vector2d cross_axis_slopes = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
};

inline Eigen::Vector2d other_axes_readings(const Eigen::Vector3d& y, int axis) {
  return {y[(axis + 1) % 3], y[(axis + 2) % 3]};
}

/// Returns the largest projection of the reading `y` onto a sensing direction with cross-axis sensitivities up to
/// `steepest`.
inline double highest_value(const Eigen::Vector3d& y, int axis, int sign, double steepest) {
  return sign * y[axis] + steepest * other_axes_readings(y, axis).lpNorm<1>();
}

struct ExtremeReading {
  int axis = 0, side = 1;
  double slab_thickness = 0.0;
  double max_cross_axis_slope = 0.0, near_readings_min = 0.0;
};

/// Returns nothing if the largest reading of the axis is too small for saturation. Cost: O(N).
std::optional<ExtremeReading> find_extreme_reading(const SaturationPlaneFinder::Params& params,
                                                   const DistinctReadings& readings, int axis, int sign,
                                                   const PlaneSlopePrior& prior, double slope_range,
                                                   SaturationPlaneFinder::Workspace& workspace);

/// Returns the cross-axis sensitivities of the plane with the most readings immediately below the plane: rails.md
/// (R57).
Eigen::Vector2d search_cross_axis_slopes(const DistinctReadings& readings, const ExtremeReading& extreme,
                                         double slope_max, const PlaneSlopePrior& prior,
                                         SaturationPlaneFinder::Workspace& workspace);

/// Fits a plane to the saturated readings, starting from the cross-axis sensitivities `slopes`: rails.md (R58).
SaturationPlaneSide fit_saturation_plane(const DistinctReadings& readings, const ExtremeReading& extreme,
                                         const PlaneSlopePrior& prior, const Eigen::Vector2d& slopes, double deviation,
                                         SaturationPlaneFinder::Workspace& workspace);

}  // namespace tumble::rails
