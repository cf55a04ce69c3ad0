// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "odometry_impl.hpp"
#include "tumble/mapping/lidar_inertial_odometry_fields.hpp"

namespace tumble::mapping {

namespace {

constexpr int kBriefIterations = 8;
constexpr int kCoarseIterations = 15;
constexpr std::size_t kCoarseMatches = 50;

}  // namespace

/// mapping.md (R36).
double knot_correlation(const LidarInertialOdometry::Params& params, const SweepTrajectory& trajectory) {
  return std::exp(-trajectory.duration_s() / (SweepTrajectory::kKnots - 1) / params.excess_time_s);
}

void check_params(const LidarInertialOdometry::Params& params) {
  require_fields(params);
  require_within("range_max_m", params.range_max_m, params.range_min_m, 1e4);
  require_within("map_spacing_m", params.map_spacing_m, 0.0, params.map_voxel_m);
  if (params.body) require_within("body.p_IB_I_m", params.body->p_IB_I_m.norm(), 0.0, 1e3);
  require_within("map_radius_m", params.map_radius_m, params.range_max_m / 10.0, 1e5);
  const double orthogonality =
      (params.T_IL.linear() * params.T_IL.linear().transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require_within("T_IL rotation's distance from orthogonal", orthogonality, 0.0, 1e-6);
  require_within("T_IL translation", params.T_IL.translation().norm(), 0.0, 1e3);
}

Registration::Params registration_params(const LidarInertialOdometry::Params& params) {
  Registration::Params out;
  out.neighbours = params.neighbours;
  out.plane.neighbours_min = std::min(out.plane.neighbours_min, params.neighbours);
  out.match_distance_m = params.match_distance_m;
  out.iterations_max = params.iterations_max;
  out.skew_sigma_m_s = params.skew_sigma_m_s;
  out.correction_max_m = params.correction_max_m;
  out.correction_max_rad = params.correction_max_rad;
  out.matches_min = params.matches_min;
  out.parallel_for = params.parallel_for;
  return out;
}

RangeNoise range_noise(const LidarInertialOdometry::Params& params) {
  const Registration::Params registration = registration_params(params);
  return {registration.range_sigma_m, registration.range_sigma_share};
}

Registration::Params brief_registration_params(const LidarInertialOdometry::Params& params) {
  Registration::Params out = registration_params(params);
  out.iterations_max = std::min(params.iterations_max, kBriefIterations);
  return out;
}

Registration::Params coarse_registration_params(const LidarInertialOdometry::Params& params) {
  Registration::Params out = registration_params(params);
  out.match_distance_m = std::min(2.0 * params.match_distance_m, 10.0);
  out.iterations_max = std::min(params.iterations_max, kCoarseIterations);
  out.kernel_min_m = 0.5;
  out.rematch_m = 0.2;
  out.step_m = 5e-3;
  out.step_rad = 2e-3;
  out.matches_min = std::min<std::size_t>(params.matches_min, kCoarseMatches);
  out.fitting_share_min = 0.2;
  return out;
}

}  // namespace tumble::mapping
