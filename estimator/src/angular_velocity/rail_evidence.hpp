// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tumble {

/// The readings of a gyro without those that only repeat the one before (sample and hold), and what they tell of the
/// gyro itself.
struct DistinctReadings {
  std::vector<Eigen::Vector3d>& rates;
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();  ///< of a reading, from where the motion is gentlest [rad/s]
  Eigen::Vector3d digit = Eigen::Vector3d::Zero();  ///< smallest change between two readings [rad/s]
  Eigen::Vector3d peak = Eigen::Vector3d::Zero();   ///< largest magnitude of each axis [rad/s]
};
/// Of readings in order of time; kept in `rates`. `noises`: scratch space.
DistinctReadings distinct_readings(std::span<const Eigen::Vector3d> readings, std::vector<Eigen::Vector3d>& rates,
                                   std::vector<double>& noises);

/// A plane that bounds the readings, sign * row . y = level, and the readings in the slab at it.
struct RailFacet {
  int axis = 0, sign = 1;
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double level = 0.0;
  double deviation = 0.0, tolerance = 0.0;
  int segments = 0;  ///< runs of inliers that no round top explains
};

/// Log likelihood ratio of the facet's samples: at a rail, against tops of a motion or constant rates. Counts the
/// segments of `facet`. `slope_information`: of what was known of the slopes before. `inliers`: the readings at the
/// facet, of DistinctReadings::rates, rising.
double segment_evidence(const DistinctReadings& readings, const Eigen::Matrix2d& slope_information,
                        std::span<const std::size_t> inliers, RailFacet& facet);

}  // namespace tumble
