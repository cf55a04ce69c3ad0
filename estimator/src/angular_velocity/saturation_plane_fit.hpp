// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"

namespace tumble {

struct DistinctReadings {
  std::vector<Eigen::Vector3d>& rates;
  /// gyro noise: lower quantile of the noise in short time windows [rad/s]
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();
  Eigen::Vector3d min_reading_change = Eigen::Vector3d::Zero();  ///< smallest change between two readings [rad/s]
  Eigen::Vector3d peak = Eigen::Vector3d::Zero();                ///< largest magnitude of each axis [rad/s]
};
DistinctReadings distinct_readings(std::span<const Eigen::Vector3d> readings, std::vector<Eigen::Vector3d>& rates,
                                   std::vector<double>& noises);

/// SaturationPlaneCandidate is a possible saturation plane (SaturationPlane): a reading y is on the plane if sign * row
/// . y = level.
struct SaturationPlaneCandidate {
  int axis = 0, side = 1;
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double plane_distance = 0.0;
  double noise_sigma_rad_s = 0.0, plane_tolerance_rad_s = 0.0;
  int segments = 0;  ///< number of segments of successive readings on the plane, without rounded maxima of the motion
};

/// Returns the log-likelihood ratio between saturation and natural causes (maxima of the motion, constant rates) for
/// the readings on `plane`. `slope_information` is the prior information about the cross-axis sensitivities.
double plateau_segment_evidence(const DistinctReadings& readings, const Eigen::Matrix2d& slope_information,
                                std::span<const std::size_t> inliers, SaturationPlaneCandidate& facet);

}  // namespace tumble

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
