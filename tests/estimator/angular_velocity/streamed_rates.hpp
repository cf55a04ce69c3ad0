// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

/// Returns all results of the stream for these samples, including the results at its end.
inline std::vector<RateState> streamed_rates(const RateStream& method, const std::vector<ImuSample>& samples,
                                             RateStream::State& state) {
  std::vector<RateState> out;
  std::optional<RateState> one;
  for (const ImuSample& sample : samples) {
    const Status status = method.push(sample, state, one);
    EXPECT_TRUE(status.ok()) << status.message();
    if (one) out.push_back(*one);
  }
  method.flush(state, out);
  return out;
}

}  // namespace tumble
