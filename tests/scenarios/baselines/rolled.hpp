// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/rolling/rolling_truth.hpp"
#include "tests/testing.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// Returns the state of a method after the samples `from` to `to` - 1 of the path and their true attitudes.
template <typename Method>
typename Method::State rolled(const Method& method, const testing::RollingTruth& truth, std::size_t from,
                              std::size_t to, typename Method::State state = {}) {
  for (std::size_t k = from; k < to; ++k) {
    const Status status = method.step(truth.samples[k], truth.q_WI[k], state);
    EXPECT_TRUE(status.ok()) << k << ": " << status.message();
  }
  return state;
}

template <typename Method>
typename Method::State rolled(const Method& method, const testing::RollingTruth& truth) {
  return rolled(method, truth, 0, truth.samples.size());
}

}  // namespace tumble::baselines
