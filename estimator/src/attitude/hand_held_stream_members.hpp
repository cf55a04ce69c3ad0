// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../angular_velocity/rails_members.hpp"
#include "../angular_velocity/rate_model_members.hpp"
#include "tumble/attitude/detail/hand_held_pipeline.hpp"
#include "tumble/attitude/hand_held_stream.hpp"

/// hand_held_stream_members.hpp lists the members of the states and parameters of HandHeldStream and HandHeldPipeline,
/// for saving (see state_visitor.hpp).
namespace tumble {

namespace hand_held {

template <StateOf<ElementSums> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sums.n", s.count);
  visit("sums.t_s", s.time_sum_s);
  visit("sums.tt_s2", s.time_squared_sum_s2);
  visit("sums.z", s.reading_sum);
  visit("sums.zt", s.reading_time_sum);
  visit("sums.clipped", s.clipped);
  visit("sums.clipped_t_s", s.clipped_time_s);
  visit("sums.rail", s.rail);
  visit("sums.sign", s.sign);
  visit("sums.unread", s.unusable_count);
  visit("sums.unread_z", s.unusable_mean);
  visit("sums.open", s.partial_saturation_sigma);
}

template <StateOf<NodeReadings> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("readings.gyro", s.gyro);
  visit("readings.force_m_s2", s.force_m_s2);
  visit("readings.force_bound", s.force_bound);
  visit("readings.force_n", s.force_count);
  visit("readings.force_t_s", s.force_time_s);
  visit("readings.force_timing_m_s2", s.force_timing_sigma_m_s2);
  visit("readings.rest", s.rest);
}

template <StateOf<Node> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("node.q_WI", s.q_WI);
  visit("node.w_WI_I_rad_s", s.w_WI_I_rad_s);
  visit("node.angular_acceleration_rad_s2", s.angular_acceleration_rad_s2);
  visit("node.a_W_m_s2", s.a_W_m_s2);
  visit("node.v_W_m_s", s.v_W_m_s);
  visit("node.p_W_m", s.p_W_m);
}

template <StateOf<Constants> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("constants.gyro_bias_rad_s", s.gyro_bias_rad_s);
  visit("constants.accel_bias_m_s2", s.accel_bias_m_s2);
  visit("constants.lever_arm_m", s.lever_arm_m);
}

}  // namespace hand_held

template <StateOf<ClipSigns> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("signs.gyro", s.gyro);
  visit("signs.accel", s.accel);
}

template <StateOf<HandHeldStream::Reading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("reading.sample", s.sample);
  visit("reading.signs", s.signs);
  visit("reading.centre_s", s.centre_s);
  visit("reading.end_s", s.end_s);
  visit("reading.node", s.node);
  visit("reading.rest", s.rest);
  visit("reading.gyro", s.gyro);
  visit("reading.accel", s.accel);
  visit("reading.smoothed", s.smoothed);
}

template <StateOf<HandHeldStream::Knot> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("carried.node", s.node);
  visit("carried.readings", s.readings);
}

template <StateOf<HandHeldStream::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("carried.readings", s.readings);
  visit("carried.window", s.window);
  visit("carried.first_node", s.first_node);
  visit("carried.rows", s.rows);
  visit("carried.constants", s.constants);
  visit("carried.constants_covariance", s.constants_covariance);
  visit("carried.prior", s.prior);
  visit("carried.prior_corner", s.prior_corner);
  visit("carried.prior_node", s.prior_node);
  visit("carried.prior_constants", s.prior_constants);
  visit("carried.acceleration_power_ratio", s.acceleration_power_ratio);
  visit("carried.rests", s.rests);
  visit("carried.reported_node", s.reported_node);
  visit("carried.reported_covariance_rad2_s2", s.reported_covariance_rad2_s2);
  visit("carried.start_ns", s.start_ns);
  visit("carried.samples", s.samples);
  visit("carried.failures", s.failures);
  visit("carried.hidden_s", s.clipped_duration_s);
  visit("carried.clipped_angle_sigma_rad", s.clipped_angle_sigma_rad);
  visit("carried.revolutions_open", s.revolutions_ambiguous);
  visit.scratch(s.work);
}

template <StateOf<HandHeldPipeline::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("live.stream", s.stream);
  visit("live.rails", s.rails);
  visit("live.repeat_state", s.repeat_state);
  visit("live.news", s.levels_changed);
  visit.scratch(s.signs);
}

template <StateOf<HandHeldPipeline::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  others(p.rails.clipping.axis_aligned_rails, visit);
  others(p.rails.clipping.planes, visit);
  others(p.rails.clipping.accel_planes, visit);
}

}  // namespace tumble
