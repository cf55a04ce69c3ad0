// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_visitor.hpp"
#include "tumble/common/sample_clock.hpp"

namespace tumble {

template <StateOf<SampleClock::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("stamps.samples", s.samples, 0.0, SampleClock::kStart - 1.0);
  visit.leading("stamps.start", s.start, s.samples);
  visit("stamps.stamp_ns", s.stamp_ns);
  visit("stamps.time_ns", s.time_ns);
  visit("stamps.line", s.line);
  visit("stamps.period_ns", s.period_ns, 0.0, 1e11);
  visit("stamps.ahead_ns", s.ahead_ns);
  visit("stamps.sum", s.sum, 0.0, 1e9);
  visit("stamps.sum_n", s.sum_n);
  visit("stamps.sum_nn", s.sum_nn);
  visit("stamps.square_ns2", s.square_ns2, 0.0, 1e30);
  visit("stamps.product_ns2", s.product_ns2);
  visit("stamps.error_ns", s.error_ns);
  visit("stamps.strays", s.strays, 0.0, 1e3);
}

}  // namespace tumble
