// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../angular_velocity/rails_members.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

namespace tumble {

template <StateOf<RollingNominal> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("nominal.q_WI", s.q_WI);
  visit("nominal.v_WI_m_s", s.v_WI_m_s);
  visit("nominal.p_WI_m", s.p_WI_m);
  visit("nominal.gyro_bias_rad_s", s.gyro_bias_rad_s);
  visit("nominal.accel_bias_m_s2", s.accel_bias_m_s2);
  visit("nominal.accel_scale", s.accel_scale);
  visit("nominal.gyro_scale", s.gyro_scale);
  visit("nominal.accel_delay_s", s.accel_delay_s);
  visit("nominal.lever_arm_error_m", s.lever_arm_error_m);
  visit("nominal.slope", s.slope);
  visit("nominal.radius_error_m", s.radius_error_m);
  visit("nominal.last_rate_I_rad_s", s.last_rate_I_rad_s);
}

template <StateOf<RollingIntegrals> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sums.R_s", s.rotation_integral_s);
  visit("sums.R_force_s", s.rotation_integral_used_force_s);
  visit("sums.f_W_m_s", s.force_integral_W_m_s);
  visit("sums.R_f", s.rotation_force_integral);
  visit("sums.R_w", s.rotation_rate_integral);
  visit("sums.rotated_rate_cross_force", s.rate_cross_force_integral_W);
  visit("sums.w_I_rad", s.rate_integral_I_rad);
  visit("sums.f_I_m_s", s.force_integral_I_m_s);
  visit("sums.rotated_rad2_s", s.squared_rate_integral_rad2_s);
  visit("sums.rate_clipped_s", s.rate_clipped_s);
  visit("sums.force_clipped_s", s.force_clipped_s);
  visit("sums.recovered_s", s.recovered_rate_s);
  visit("sums.impact_m_s", s.impact_m_s);
  visit("sums.unexplained_impact_m_s", s.unexplained_impact_m_s);
  visit("sums.subsample_saturation_W_m_s", s.subsample_saturation_W_m_s);
  visit("sums.gap_s", s.gap_s);
  visit("sums.gap_angle_variance_rad2", s.gap_angle_variance_rad2);
  visit("sums.gap_rate_variance_rad2_s", s.gap_rate_variance_rad2_s);
  visit("sums.gap_speed_variance_m2_s2", s.gap_speed_variance_m2_s2);
  visit("sums.node_s", s.node_s);
}

template <StateOf<RollingFilter::Hypothesis> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("hypothesis.x", s.x);
  visit("hypothesis.P", s.P);
  visit("hypothesis.contact_velocity_W_m_s", s.contact_velocity_W_m_s);
  visit("hypothesis.log_weight", s.log_weight);
  visit("hypothesis.switched_node", s.mode_start_node);
  visit("hypothesis.parent", s.parent, 0.0, RollingFilter::kHypotheses - 1.0);
  visit("hypothesis.mode", s.mode, RollingMode::rough);
}

template <StateOf<RollingFilter::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("live.p_WG_m", s.p_WG_m);
  visit("live.v_WG_m_s", s.v_WG_m_s);
  visit("live.q_WI", s.q_WI);
  visit("live.position_covariance_m2", s.position_covariance_m2);
  visit("live.contact_velocity_m_s", s.contact_velocity_m_s);
  visit("live.mode", s.mode, RollingMode::rough);
  visit("live.slip_probability", s.slip_probability);
  visit("live.bump_probability", s.bump_probability);
  visit("live.at_rest", s.at_rest);
  visit("live.spins_in_place", s.spins_in_place);
  visit("live.uncertain", s.uncertain);
  visit("live.started_in_motion", s.started_in_motion);
  visit("live.gaps", s.gaps);
  visit("live.gap_longest_s", s.gap_longest_s);
  visit("live.nominal", s.nominal);
  visit("live.sums", s.sums);
  visit("live.average", s.average);
  visit("live.pruned_spread_m2", s.pruned_position_spread_m2);
  visit("live.rest", s.rest);
  visit("live.slow_rate_rad_s", s.low_passed_rate_rad_s);
  visit("live.position_constrained", s.position_constrained);
  visit("live.variance_before_event_m2", s.variance_before_event_m2);
  visit("live.last_rate_rad_s", s.last_rate_rad_s);
  visit("live.count", s.count, 0.0, RollingFilter::kHypotheses);
  visit.leading("live.hypotheses", s.hypotheses, static_cast<std::size_t>(s.count));
  visit("live.node", s.node);
  visit("live.last_time_ns", s.last_time_ns);
  visit("live.started", s.started);
}

template <StateOf<RollingSmoother::NodeModes> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  for (auto& parent : s.parent) visit("step.parent", parent, 0.0, RollingFilter::kHypotheses - 1.0);
  for (auto& mode : s.mode) visit("step.mode", mode, RollingMode::rough);
  visit("step.spread_m2", s.position_spread_m2);
  visit("step.rest_s", s.rest_s);
  visit("step.at_rest", s.at_rest);
  visit("step.spins_in_place", s.spins_in_place);
}

template <StateOf<RollingSmoother::FinalPassState> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("committed.nominal", s.nominal);
  visit("committed.P", s.P);
  visit("committed.mode", s.mode, RollingMode::rough);
  visit("committed.event_start_variance_m2", s.event_start_variance_m2);
  visit("committed.constrained_p_WG_m", s.constrained_p_WG_m);
  visit("committed.position_constrained", s.position_constrained);
  visit("committed.last_time_ns", s.last_time_ns);
  visit("committed.last_rate_rad_s", s.last_rate_rad_s);
  visit("committed.gap_rate_rad_s", s.gap_rate_rad_s);
  visit("committed.gap_start_ns", s.gap_start_ns);
  visit("committed.gap_piece", s.gap_step, 0.0, 1e6);
  visit("committed.started", s.started);
}

template <StateOf<RollingSmoother::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rolling.live", s.live);
  visit("rolling.committed", s.committed);
  visit("rolling.samples", s.samples);
  visit("rolling.steps", s.steps);
  visit("rolling.constants", s.constants);
  visit("rolling.radius_sigma_m", s.radius_sigma_m);
}

template <StateOf<RollingEstimate> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("estimate.time_ns", s.time_ns);
  visit("estimate.p_WG_m", s.p_WG_m);
  visit("estimate.q_WI", s.q_WI);
  visit("estimate.v_WG_m_s", s.v_WG_m_s);
  visit("estimate.w_WI_I_rad_s", s.w_WI_I_rad_s);
  visit("estimate.covariance", s.covariance);
  visit("estimate.mode", s.mode, RollingMode::rough);
  visit("estimate.at_rest", s.at_rest);
  visit("estimate.uncertain", s.uncertain);
}

template <StateOf<RollingParams> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit("q_WI_start", p.q_WI_start);
}

template <StateOf<RollingSmoother::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  others(p.filter, visit);
}

}  // namespace tumble
