// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble {

/// Result of a plane fit to a neighbourhood of map points.
enum class PlaneVerdict { plane, too_few, collinear, one_line, rough };

/// Plane through a neighbourhood: normal . x = normal . centre.
struct PlaneFit {
  PlaneVerdict verdict = PlaneVerdict::too_few;
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< unit length, arbitrary sign
  Eigen::Vector3f centre_W_m = Eigen::Vector3f::Zero();
  float thickness2_m2 = 0.0f;  ///< smallest eigenvalue of the neighbours' covariance
  /// Standard deviation of the normal's error along the two axes of the plane, as columns. The standard deviation is
  /// that of a regression whose residuals equal the neighbourhood's thickness.
  Eigen::Matrix<float, 3, 2> tilt_W = Eigen::Matrix<float, 3, 2>::Zero();
};

/// Limits on the eigenvalues l0 <= l1 <= l2 of the covariance of a neighbourhood.
struct PlaneBounds {
  int neighbours_min = 5;
  /// If l1 is below this fraction of l2, the neighbours are collinear (a ring of a lidar at rest) and the normal would
  /// be wrong.
  double collinear_share = 0.03;
  double rough_share = 0.1;  ///< if l0 is above this fraction of l1, there is no plane
  /// Minimum number of neighbours that are not on the most frequent scan line. With fewer neighbours off the line, the
  /// fit could be the plane of the ring instead of the surface. Examples are a ring around a pillar or through a room's
  /// corner.
  int off_line_min = 2;

  /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours_min, {"neighbours_min", "1", 3, 32, "least number of map points for a plane"});
    visit(p.collinear_share, {"collinear_share", "1", 0.0, 1.0,
                              "least ratio of middle to largest eigenvalue; below, the neighbours form a line"});
    visit(p.rough_share,
          {"rough_share", "1", 0.0, 1.0, "largest ratio of smallest to middle eigenvalue; above, there is no plane"});
    visit(p.off_line_min,
          {"off_line_min", "1", 0, 32, "least number of neighbours outside the most frequent scan line"});
  }
};

/// Fits a least-squares plane to a set of map points. Does not allocate.
PlaneFit fit_plane(const VoxelMap& map, const Neighbours& neighbours, const PlaneBounds& bounds);

}  // namespace tumble
