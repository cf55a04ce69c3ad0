// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble {

/// What a neighbourhood of map points allows.
enum class PlaneVerdict { plane, too_few, collinear, one_line, rough };

/// Plane through a neighbourhood: normal . x = normal . centre.
struct PlaneFit {
  PlaneVerdict verdict = PlaneVerdict::too_few;
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< unit, sign arbitrary
  Eigen::Vector3f centre_W_m = Eigen::Vector3f::Zero();
  float thickness2_m2 = 0.0f;  ///< least eigenvalue of the neighbours' covariance
  /// Standard deviation of the normal's error along the two axes of the plane, as columns: that of a regression on
  /// neighbours that lie off the plane by chance, as far as their thickness shows.
  Eigen::Matrix<float, 3, 2> tilt_W = Eigen::Matrix<float, 3, 2>::Zero();
};

/// Bounds on the eigenvalues l0 <= l1 <= l2 of the covariance of a neighbourhood.
struct PlaneBounds {
  int neighbours_min = 5;
  /// l1 below this share of l2: the neighbours lie on a line (a lidar's ring at rest) and the normal would be false.
  double collinear_share = 0.03;
  double rough_share = 0.1;  ///< l0 above this share of l1: no plane
  /// Fewer neighbours than this beside the most frequent scan line: the plane would be that of the ring, not of the
  /// surface (a ring around a pillar or through a corner of a room is flat, and its normal is false).
  int off_line_min = 2;

  /// Every number of it, stated once.
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

/// Least-squares plane of a set of map points. Does not allocate.
PlaneFit fit_plane(const VoxelMap& map, const Neighbours& neighbours, const PlaneBounds& bounds);

}  // namespace tumble
