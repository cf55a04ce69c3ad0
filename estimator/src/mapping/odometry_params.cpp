// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "odometry_impl.hpp"

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
  require_within("gravity_m_s2", params.gravity_m_s2, 0.0, 100.0);
  require_within("rest_s", params.rest_s, 1e-9, 60.0);
  require_within("rest_rate_rad_s", params.rest_rate_rad_s, 0.0, 10.0);
  require_within("rest_force_m_s2", params.rest_force_m_s2, 0.0, 10.0);
  require_within("range_min_m", params.range_min_m, 0.0, 10.0);
  require_within("range_max_m", params.range_max_m, params.range_min_m, 1e4);
  require_within("sweep_voxel_m", params.sweep_voxel_m, 0.01, 10.0);
  require_within("map_voxel_m", params.map_voxel_m, 0.01, 10.0);
  require_within("map_spacing_m", params.map_spacing_m, 0.0, params.map_voxel_m);
  require_within("neighbours", params.neighbours, 3, Neighbours::kMax);
  require_within("prior_sigma_m", params.prior_sigma_m, 1e-9, 1e3);
  require_within("prior_sigma_rad", params.prior_sigma_rad, 1e-9, 1e3);
  require_within("prior_sigma_m_s", params.prior_sigma_m_s, 1e-9, 1e3);
  require_within("turn_sigma_share", params.turn_sigma_share, 0.0, 1.0);
  require_within("force_sigma_share", params.force_sigma_share, 0.0, 1.0);
  require_within("accel_rail_m_s2", params.accel_rail_m_s2, 1e-9, 1e5);
  require_within("railed_force_m_s2", params.railed_force_m_s2, 0.0, 1e4);
  require_within("trusted_prior_m", params.trusted_prior_m, 0.0, 1e3);
  require_within("trusted_prior_rad", params.trusted_prior_rad, 0.0, 1e3);
  require_within("clipped_sigma_rad_s", params.clipped_sigma_rad_s, 0.0, 100.0);
  require_within("rate_sigma_max_rad_s", params.rate_sigma_max_rad_s, 0.0, 100.0);
  require_within("excess_sigma_min_rad_s", params.excess_sigma_min_rad_s, 1e-9, 100.0);
  require_within("excess_time_s", params.excess_time_s, 1e-3, 1e3);
  require_within("flight_force_m_s2", params.flight_force_m_s2, 0.0, 100.0);
  if (params.body) require_within("body.p_IB_I_m", params.body->p_IB_I_m.norm(), 0.0, 1e3);
  require_within("window_sweeps", params.window_sweeps, 1, 8);
  require_within("degenerate_sigma_m", params.degenerate_sigma_m, 1e-6, 1e3);
  require_within("time_offset_s", params.time_offset_s, -1.0, 1.0);
  require_within("mount_sigma_rad", params.mount_sigma_rad, 0.0, 1.0);
  require_within("mount_sigma_m", params.mount_sigma_m, 0.0, 1.0);
  require_within("time_offset_sigma_s", params.time_offset_sigma_s, 0.0, 0.02);
  require_within("gravity_sigma_m_s2", params.gravity_sigma_m_s2, 0.0, 10.0);
  require_within("map_radius_m", params.map_radius_m, params.range_max_m / 10.0, 1e5);
  require_within("map_sigma_max_m", params.map_sigma_max_m, 1e-6, 1e3);
  require_within("lost_sweeps_max", params.lost_sweeps_max, 1, 1e6);
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
