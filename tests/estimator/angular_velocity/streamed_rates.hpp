// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

/// Returns all rates that the stream reports for the samples, including those at its end.
inline std::vector<AngularRateState> streamed_rates(const AngularRateStream& method,
                                                    const std::vector<ImuSample>& samples,
                                                    AngularRateStream::State& state) {
  std::vector<AngularRateState> out;
  std::optional<AngularRateState> one;
  for (const ImuSample& sample : samples) {
    const Status status = method.push(sample, state, one);
    EXPECT_TRUE(status.ok()) << status.message();
    if (one) out.push_back(*one);
  }
  method.flush(state, out);
  return out;
}

}  // namespace tumble
