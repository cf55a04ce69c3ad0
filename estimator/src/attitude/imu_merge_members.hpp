// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../angular_velocity/rails_members.hpp"
#include "tumble/attitude/imu_merge.hpp"

/// imu_merge_members.hpp lists the members of ImuMerge's state and further members of ImuMerge::Params, for saving (see
/// state_visitor.hpp).
namespace tumble {

template <StateOf<ForceErrors::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("forces.x", s.x);
  visit("forces.P", s.P);
  visit("forces.difference_m_s2", s.difference_m_s2);
  visit("forces.force_m_s2", s.force_m_s2);
  visit("forces.by_position", s.jacobian_position);
  visit("forces.acceleration_rad_s2", s.acceleration_rad_s2);
  visit("forces.samples", s.samples);
  visit("forces.span_s", s.span_s);
  visit("forces.started", s.started);
}

template <StateOf<RateRecovery::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("recovery.x", s.x);
  visit("recovery.P", s.P);
  visit("recovery.started", s.started);
  visit("recovery.running", s.running);
}

template <StateOf<UnitSignCheck> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sign_check.gain_m2_s3", s.explained_m2_s3);
  visit("sign_check.size_m2_s3", s.effect_m2_s3);
}

template <StateOf<ImuMerge::Repetition> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("hold.reading", s.reading);
  visit("hold.others", s.others);
  visit("hold.turned_rad", s.turned_rad);
  visit("hold.since_ns", s.since_ns);
  visit("hold.repeated_s", s.repeated_s);
}

template <StateOf<ImuMerge::Unit> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("unit.x", s.x);
  visit("unit.P", s.P);
  visit("unit.window", s.window);
  visit("unit.last_rate_rad_s", s.last_rate_rad_s);
  visit("unit.last_force_m_s2", s.last_force_m_s2);
  visit("unit.suspect_s", s.exclusion_left_s);
  visit("unit.left_out", s.excluded_windows);
  visit("unit.rate_repeat", s.rate_repeat);
  visit("unit.force_repeat", s.force_repeat);
  visit("unit.thawing_s", s.changing_readings_s);
  visit("unit.misfit_rate_rad_s", s.rate_disagreement_rad_s);
  visit("unit.misfit_force_m_s2", s.force_disagreement_m_s2);
  visit("unit.misfits_s", s.disagreement_s);
  visit("unit.misfits_since_ns", s.disagreement_since_ns);
  visit("unit.frozen", s.frozen);
  visit("unit.disagrees", s.disagrees);
  visit("unit.absent", s.missing_samples);
  visit("unit.frozen_since_ns", s.frozen_since_ns);
  visit("unit.disagrees_since_ns", s.disagrees_since_ns);
  visit("unit.absent_since_ns", s.missing_since_ns);
}

template <StateOf<ImuMerge::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("merge.units", s.units);
  visit("merge.forces", s.forces);
  visit("merge.recovery", s.recovery);
  visit("merge.rate_rad_s", s.rate_rad_s);
  visit("merge.previous_rate_rad_s", s.previous_rate_rad_s);
  visit("merge.rotation_rate_rad_s", s.rotation_rate_rad_s);
  visit("merge.window_s", s.window_s);
  visit("merge.length_s", s.length_s);
  visit("merge.previous_length_s", s.previous_length_s);
  visit("merge.lever_arm_correlation", s.lever_arm_correlation);
  visit("merge.arm_square_m2_s3", s.lever_arm_effect_m2_s3);
  visit("merge.sign_check", s.sign_check);
  visit("merge.samples", s.samples);
  visit("merge.windows", s.windows);
  visit("merge.free_windows", s.unclipped_windows);
  visit("merge.last_time_ns", s.last_time_ns);
  visit("merge.all_frozen", s.all_frozen);
}

/// Visits all members of ImuMerge::Params except the poses of the IMUs, which the parameters of RollingOdometry
/// contain.
template <StateOf<ImuMerge::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit.scratch(p.T_CI);
  visit("gyro_elements", p.gyro_elements);
  visit("accel_elements", p.accel_elements);
}

}  // namespace tumble
