// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/state_visitor.hpp"
#include "tumble/odometry/detail/stamp_order.hpp"

/// stamp_order_members.hpp lists the members of StampOrder's state, for saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<RejectedStamps> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("order.first_ns", s.first_ns);
  visit("order.last_ns", s.last_ns);
}

template <StateOf<StampOrder::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("order.newest_ns", s.newest_ns);
  visit("order.single", s.single);
  visit("order.rejected", s.rejected);
}

}  // namespace tumble
