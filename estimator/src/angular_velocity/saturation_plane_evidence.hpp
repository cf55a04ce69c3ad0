// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

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
