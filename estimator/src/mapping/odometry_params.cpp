// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_impl.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

namespace {

/// Eigen's empty box says that there is none; any other without an inside has corners that are swapped.
void require_corners_in_order(const Eigen::AlignedBox3d& box) {
  const Eigen::AlignedBox3d none;
  if (box.min() == none.min() && box.max() == none.max()) return;
  require_within("own_body_L largest x less the least", box.sizes().x(), 0.0, kUnbounded);
  require_within("own_body_L largest y less the least", box.sizes().y(), 0.0, kUnbounded);
  require_within("own_body_L largest z less the least", box.sizes().z(), 0.0, kUnbounded);
}

}  // namespace

void check_params(const LidarInertialOdometry::Params& params) {
  require_fields(params);
  require_within("range_max_m", params.range_max_m, params.range_min_m, 1e4);
  require_within("map_spacing_m", params.expert.map.spacing_m, 0.0, params.expert.map.voxel_m);
  if (params.expert.flight.body) require_within("body.p_IB_I_m", params.expert.flight.body->p_IB_I_m.norm(), 0.0, 1e3);
  require_within("map_radius_m", params.expert.map.radius_m, params.range_max_m / 10.0, 1e5);
  const double orthogonality =
      (params.T_IL.linear() * params.T_IL.linear().transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require_within("T_IL rotation's distance from orthogonal", orthogonality, 0.0, 1e-6);
  require_within("T_IL rotation's determinant", params.T_IL.linear().determinant(), 0.999, 1.001);
  require_corners_in_order(params.own_body_L);
  require_within("T_IL translation", params.T_IL.translation().norm(), 0.0, 1e3);
}

}  // namespace tumble::mapping
