// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/status.hpp"
#include "tumble/rolling/rolling_model.hpp"

namespace tumble {

namespace {

constexpr double kSmallest = 1e-12;

void require_sigmas(const RollingParams& p) {
  require_within("tilt_sigma_rad", p.tilt_sigma_rad, 0.0, 1e3);
  require_within("velocity_sigma_m_s", p.velocity_sigma_m_s, 0.0, 1e3);
  require_within("gyro_bias_sigma_rad_s", p.gyro_bias_sigma_rad_s, 0.0, 1e3);
  require_within("accel_bias_sigma_m_s2", p.accel_bias_sigma_m_s2, 0.0, 1e3);
  require_within("accel_scale_sigma", p.accel_scale_sigma, 0.0, 1e3);
  require_within("gyro_scale_sigma", p.gyro_scale_sigma, 0.0, 1e3);
  require_within("accel_delay_sigma_s", p.accel_delay_sigma_s, 0.0, 1e3);
  require_within("lever_arm_sigma_m", p.lever_arm_sigma_m, 0.0, 1e3);
  require_within("radius_sigma_m", p.radius_sigma_m, 0.0, 1e3);
  require_within("slope_sigma", p.slope_sigma, 0.0, 1e3);
}

void require_noise(const RollingParams& p) {
  require_within("attitude_walk_rad_sqrts", p.attitude_walk_rad_sqrts, kSmallest, 1e3);
  require_within("rate_error_sqrts", p.rate_error_sqrts, kSmallest, 1e3);
  require_within("velocity_walk_m_s_sqrts", p.velocity_walk_m_s_sqrts, kSmallest, 1e3);
  require_within("spin_force_sqrts", p.spin_force_sqrts, 0.0, 1e3);
  require_within("gyro_bias_walk_rad_s_sqrts", p.gyro_bias_walk_rad_s_sqrts, kSmallest, 1e3);
  require_within("accel_bias_walk_m_s2_sqrts", p.accel_bias_walk_m_s2_sqrts, kSmallest, 1e3);
  require_within("grip_sigma_m_s", p.grip_sigma_m_s, kSmallest, 1e3);
  require_within("grip_sigma_share", p.grip_sigma_share, kSmallest, 1e3);
  require_within("vertical_sigma_m_s", p.vertical_sigma_m_s, kSmallest, 1e3);
  require_within("rough_share", p.rough_share, kSmallest, 1e3);
  require_within("rough_radius_walk_m_sqrts", p.rough_radius_walk_m_sqrts, 0.0, 1.0);
  require_within("slope_walk_sqrts", p.slope_walk_sqrts, kSmallest, 1e3);
  require_within("rest_velocity_sigma_m_s", p.rest_velocity_sigma_m_s, kSmallest, 1e3);
  require_within("rest_rate_sigma_rad_s", p.rest_rate_sigma_rad_s, kSmallest, 1e3);
  require_within("gyro_range_rad_s", p.gyro_range_rad_s, kSmallest, 1e3);
  require_within("subsample_saturation_share", p.subsample_saturation_share, 0.0, 10.0);
  require_within("impact_share", p.impact_share, 0.0, 1e3);
  require_within("accel_range_m_s2", p.accel_range_m_s2, kSmallest, 1e5);
  require_within("clipped_force_sigma_m_s2", p.clipped_force_sigma_m_s2, kSmallest, 1e3);
  require_within("recovered_rate_sigma_rad_s", p.recovered_rate_sigma_rad_s, 0.0, 1e3);
  require_within("unexplained_impact_m_s", p.unexplained_impact_m_s, kSmallest, 1e3);
  require_within("speed_max_m_s", p.speed_max_m_s, kSmallest, 1e3);
  require_within("speed_sigma_m_s", p.speed_sigma_m_s, kSmallest, 1e3);
  require_within("clipped_rate_sigma_rad_s", p.clipped_rate_sigma_rad_s, kSmallest, 1e3);
}

void require_modes(const RollingParams& p) {
  require_within("slip_begins_per_s", p.slip_begins_per_s, kSmallest, 1e3);
  require_within("slip_ends_per_s", p.slip_ends_per_s, kSmallest, 1e3);
  require_within("bump_begins_per_s", p.bump_begins_per_s, kSmallest, 1e3);
  require_within("bump_ends_per_s", p.bump_ends_per_s, kSmallest, 1e3);
  require_within("slip_bump_per_s", p.slip_bump_per_s, kSmallest, 1e3);
  require_within("incline_begins_per_s", p.incline_begins_per_s, kSmallest, 1e3);
  require_within("incline_ends_per_s", p.incline_ends_per_s, kSmallest, 1e3);
  require_within("rough_begins_per_s", p.rough_begins_per_s, kSmallest, 1e3);
  require_within("rough_ends_per_s", p.rough_ends_per_s, kSmallest, 1e3);
  require_within("event_shortest_s", p.event_shortest_s, 0.0, 10.0);
  require_within("rest_rate_rad_s", p.rest_rate_rad_s, kSmallest, 10.0);
  require_within("rest_force_m_s2", p.rest_force_m_s2, kSmallest, 100.0);
  require_within("rest_time_s", p.rest_time_s, 0.0, 100.0);
  require_within("uncertain_m", p.uncertain_m, kSmallest, 1e3);
}

}  // namespace

void require_valid(const RollingParams& p) {
  require_within("radius_m", p.radius_m, kSmallest, 10.0);
  require_within("gravity_m_s2", p.gravity_m_s2, kSmallest, 100.0);
  require_within("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
  if (p.q_WI_start) require_within("q_WI_start", p.q_WI_start->norm(), 1.0 - 1e-6, 1.0 + 1e-6);
  require_within("node_s", p.node_s, 1e-3, 0.1);
  require_within("reading_s", p.reading_s, 0.0, 0.1);
  require_within("gap_from_s", p.gap_from_s, 1e-9, 1.0);
  require_within("gap_max_s", p.gap_max_s, 1e-9, 1.0);
  require_within("gap_acceleration_rad_s2", p.gap_acceleration_rad_s2, kSmallest, 1e4);
  require_within("start_rate_rad_s", p.start_rate_rad_s, kSmallest, 10.0);
  require_sigmas(p);
  require_noise(p);
  require_modes(p);
}

}  // namespace tumble
