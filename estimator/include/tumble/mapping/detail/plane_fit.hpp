// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"

namespace tumble {

enum class PlaneVerdict { plane, too_few_points, collinear, one_scan_line, plane_too_thick };

/// Plane through neighbouring map points: normal . x = normal . centre.
struct PlaneFit {
  PlaneVerdict verdict = PlaneVerdict::too_few_points;
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< unit length, arbitrary sign
  Eigen::Vector3f plane_centre_W_m = Eigen::Vector3f::Zero();
  float thickness_variance_m2 = 0.0f;  ///< smallest eigenvalue of the neighbours' covariance
  /// Columns: the two axes of the plane, each times the standard deviation of the normal's error along this axis.
  Eigen::Matrix<float, 3, 2> normal_sigma_W = Eigen::Matrix<float, 3, 2>::Zero();
};

/// Limits for the eigenvalues l0 <= l1 <= l2 of the covariance of neighbouring map points.
struct PlaneFitBounds {
  int neighbours_min = 5;
  /// neighbours are collinear if l1 < collinear_ratio_max * l2, for example on one ring of a lidar at rest
  double collinear_ratio_max = 0.03;
  double rough_share = 0.1;  ///< neighbours are not a plane if l0 > rough_share * l1
  /// minimum number of neighbours that are not on the most frequent scan line; excludes planes through a single lidar
  /// ring
  int off_line_neighbours_min = 2;
};

/// Fits a least-squares plane to neighbouring map points. No memory is allocated.
PlaneFit fit_plane(const VoxelMap& map, const NearestNeighbours& neighbours, const PlaneFitBounds& bounds);

}  // namespace tumble
