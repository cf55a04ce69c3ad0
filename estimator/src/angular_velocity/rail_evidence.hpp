// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tumble {

struct DistinctReadings {
  std::vector<Eigen::Vector3d>& rates;
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();  ///< lower quantile of the noise of all windows [rad/s]
  Eigen::Vector3d digit = Eigen::Vector3d::Zero();  ///< smallest change between two readings [rad/s]
  Eigen::Vector3d peak = Eigen::Vector3d::Zero();   ///< largest magnitude of each axis [rad/s]
};
DistinctReadings distinct_readings(std::span<const Eigen::Vector3d> readings, std::vector<Eigen::Vector3d>& rates,
                                   std::vector<double>& noises);

/// RailFacet is a possible plane of saturated readings: a reading y is on the plane if sign * row . y = level.
struct RailFacet {
  int axis = 0, sign = 1;
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double level = 0.0;
  double deviation = 0.0, tolerance = 0.0;
  int segments = 0;  ///< number of runs of readings on the plane, without rounded maxima
};

/// Returns the log-likelihood ratio between saturation and natural causes (maxima of the motion, constant rates) for
/// the readings on `facet`. `slope_information` is the prior information about the cross-axis sensitivities.
double segment_evidence(const DistinctReadings& readings, const Eigen::Matrix2d& slope_information,
                        std::span<const std::size_t> inliers, RailFacet& facet);

}  // namespace tumble
