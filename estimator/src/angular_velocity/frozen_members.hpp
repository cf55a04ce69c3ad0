// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/imu_members.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"

namespace tumble {

template <StateOf<FrozenAxes::Axis> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("frozen.reading", s.reading);
  visit("frozen.since_ns", s.since_ns);
  visit("frozen.repeated_s", s.repeated_s);
  visit("frozen.flagged", s.device_flagged);
  visit("frozen.frozen", s.frozen);
  visit("frozen.longest_s", s.longest_s);
  visit("frozen.moved_s", s.changing_duration_s);
  visit("frozen.quantum", s.smallest_change);
  visit("frozen.min_reading", s.min_reading);
  visit("frozen.max_reading", s.max_reading);
  visit("frozen.other_low", s.others_min);
  visit("frozen.other_high", s.others_max);
  visit("frozen.other_changes", s.others_changes);
  visit("frozen.samples", s.samples);
}

template <StateOf<FrozenAxes::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("frozen.axes", s.axes);
  visit("frozen.before", s.before);
  visit("frozen.last_time_ns", s.last_time_ns);
  visit("frozen.fastest_rad_s", s.rate_max_so_far_rad_s);
  visit("frozen.started", s.started);
}

}  // namespace tumble
