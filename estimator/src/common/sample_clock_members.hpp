// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_visitor.hpp"
#include "tumble/common/sample_clock.hpp"

namespace tumble {

template <StateOf<SampleClock::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("stamps.samples", s.samples, 0.0, SampleClock::kFirstFitStamps - 1.0);
  visit.leading("stamps.start", s.start, s.samples);
  visit("stamps.stamp_ns", s.stamp_ns);
  visit("stamps.time_ns", s.time_ns);
  visit("stamps.line_fitted", s.line_fitted);
  visit("stamps.period_ns", s.period_ns, 0.0, 1e11);
  visit("stamps.fit_residual_ns", s.fit_residual_ns);
  visit("stamps.sum", s.sum, 0.0, 1e9);
  visit("stamps.weighted_sum_number", s.weighted_number_sum);
  visit("stamps.sum_nn", s.weighted_number_squared_sum);
  visit("stamps.mean_square_error_ns2", s.mean_square_error_ns2, 0.0, 1e30);
  visit("stamps.mean_error_product_ns2", s.lag_one_error_product_ns2);
  visit("stamps.error_ns", s.prediction_error_ns);
  visit("stamps.outliers", s.outliers, 0.0, 1e3);
}

}  // namespace tumble
