// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
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

/// Checks that a copy of the state in another method object continues with the same bits, from each of the samples
/// `splits` on.
inline void expect_same_rates_if_split(const AngularRateStream::Params& params, const std::vector<ImuSample>& samples,
                                       const std::vector<std::size_t>& splits) {
  const AngularRateStream method(params), second(params);
  AngularRateStream::State whole = method.start();
  const std::vector<AngularRateState> expected = streamed_rates(method, samples, whole);
  for (const std::size_t split : splits) {
    AngularRateStream::State state = method.start();
    std::vector<AngularRateState> rates;
    std::optional<AngularRateState> one;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (k == split) state = AngularRateStream::State(state);
      ASSERT_TRUE((k < split ? method : second).push(samples[k], state, one).ok());
      if (one) rates.push_back(*one);
    }
    second.flush(state, rates);
    ASSERT_EQ(rates.size(), expected.size());
    for (std::size_t k = 0; k < rates.size(); ++k) {
      ASSERT_EQ(rates[k].w_WI_I_rad_s, expected[k].w_WI_I_rad_s) << split << ' ' << k;
      ASSERT_EQ(rates[k].covariance_rad2_s2, expected[k].covariance_rad2_s2) << split << ' ' << k;
    }
  }
}

}  // namespace tumble
