// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/imu_members.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"

namespace tumble {

template <StateOf<FrozenAxes::Axis> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("frozen.reading", s.reading);
  visit("frozen.since_ns", s.since_ns);
  visit("frozen.held_s", s.held_s);
  visit("frozen.flagged", s.flagged);
  visit("frozen.frozen", s.frozen);
  visit("frozen.ever_frozen", s.ever_frozen);
  visit("frozen.longest_s", s.longest_s);
  visit("frozen.moved_s", s.moved_s);
  visit("frozen.quantum", s.quantum);
  visit("frozen.lowest", s.lowest);
  visit("frozen.highest", s.highest);
  visit("frozen.other_low", s.other_low);
  visit("frozen.other_high", s.other_high);
  visit("frozen.other_changes", s.other_changes);
  visit("frozen.samples", s.samples);
  visit("frozen.still_s", s.still_s);
  visit("frozen.still_at", s.still_at);
}

template <StateOf<FrozenAxes::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("frozen.axes", s.axes);
  visit("frozen.before", s.before);
  visit("frozen.last_time_ns", s.last_time_ns);
  visit("frozen.fastest_rad_s", s.fastest_rad_s);
  visit("frozen.started", s.started);
}

}  // namespace tumble
