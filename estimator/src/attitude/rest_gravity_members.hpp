// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../angular_velocity/rails_members.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"

/// rest_gravity_members.hpp lists the members of RestGravity's states, for saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<RestGravity::MagnitudeState> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("gravity.rest", s.rest);
  visit("gravity.weightless", s.weightless);
  visit("gravity.heavy", s.above_gravity);
  visit("gravity.rest_s", s.rest_s);
  visit("gravity.force_sum_m", s.force_sum_m);
  visit("gravity.weightless_s", s.weightless_s);
  visit("gravity.last_time_ns", s.last_time_ns);
  visit("gravity.started", s.started);
  visit("gravity.rests", s.rests);
}

}  // namespace tumble
