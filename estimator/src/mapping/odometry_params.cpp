// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/odometry_params.hpp"

#include "odometry_impl.hpp"

namespace tumble {

namespace {

/// If the box is empty, no points on the robot itself are removed.
template <class Visitor>
void visit_corners_in_order(const Eigen::AlignedBox3d& box, Visitor& visit) {
  const Eigen::AlignedBox3d none;
  if (box.min() == none.min() && box.max() == none.max()) return;
  visit(box.sizes().x(), {"own_body_L maximum x minus minimum x", "m", 0.0, kUnbounded, ""});
  visit(box.sizes().y(), {"own_body_L maximum y minus minimum y", "m", 0.0, kUnbounded, ""});
  visit(box.sizes().z(), {"own_body_L maximum z minus minimum z", "m", 0.0, kUnbounded, ""});
}

detail::OutOfBoundsParameter out_of_bounds(const OdometryParams& params) {
  detail::OutOfBoundsParameter found;
  detail::BoundsChecker visit(found);
  OdometryParams::fields(params, visit);
  visit(params.range_max_m, {"range_max_m", "m", params.range_min_m, 1e4, ""});
  visit(params.expert.map.spacing_m, {"map_spacing_m", "m", 0.0, params.expert.map.voxel_m, ""});
  visit(params.expert.map.radius_m, {"map_radius_m", "m", params.range_max_m / 10.0, 1e5, ""});
  const Eigen::Matrix3d R = params.T_IL.linear();
  const double orthogonality = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  visit(orthogonality, {"T_IL rotation's distance from orthogonal", "1", 0.0, 1e-6, ""});
  visit(R.determinant(), {"T_IL rotation's determinant", "1", 0.999, 1.001, ""});
  visit_corners_in_order(params.own_body_L, visit);
  visit(params.T_IL.translation().norm(), {"T_IL translation", "m", 0.0, 1e3, ""});
  return found;
}

}  // namespace

Status check_odometry_params(const OdometryParams& params) {
  return out_of_bounds(params).status;
}

void mapping::require_params(const OdometryParams& params) {
  detail::throw_if_out_of_bounds(out_of_bounds(params));
}

}  // namespace tumble
