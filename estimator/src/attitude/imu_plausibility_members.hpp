// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/imu_members.hpp"
#include "tumble/attitude/detail/imu_plausibility.hpp"

/// imu_plausibility_members.hpp lists the members of ImuPlausibility's state, for saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<ImuPlausibility::Repetition> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("plausibility.reading", s.reading);
  visit("plausibility.repeated_s", s.repeated_s);
  visit("plausibility.longest_s", s.longest_s);
  visit("plausibility.changing_duration_s", s.changing_duration_s);
  visit("plausibility.frozen_s", s.frozen_s);
}

template <StateOf<ImuPlausibility::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("plausibility.gyro", s.gyro);
  visit("plausibility.accel", s.accel);
  visit("plausibility.average", s.average);
  visit("plausibility.force_start_m_s2", s.force_start_m_s2);
  visit("plausibility.gyro_rotation", s.gyro_rotation);
  visit("plausibility.length_s", s.length_s);
  visit("plausibility.window_started", s.window_started);
  visit("plausibility.force_is_constant", s.force_is_constant);
  visit("plausibility.in_range", s.in_range);
  visit("plausibility.non_rest_force_s", s.non_rest_force_s);
  visit("plausibility.unexplained_rad2", s.unexplained_rad2);
  visit("plausibility.force_rotation_rad2", s.force_rotation_rad2);
  visit("plausibility.gyro_rotation_rad2", s.gyro_rotation_rad2);
  visit("plausibility.rotated_windows", s.rotated_windows);
  visit("plausibility.last_time_ns", s.last_time_ns);
  visit("plausibility.started", s.started);
}

}  // namespace tumble
