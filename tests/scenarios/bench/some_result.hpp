// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/bench/bench_result.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios::testing {

inline constexpr const char* kError = "rate_error_clipped_median_rad_s";

/// Returns a result of the draws `hill 1`, `hill 2`, ... with these errors; a negative error means that the run
/// crashed, a missing one that nothing was saturated. The first draw is mild and all others are wild.
inline BenchResult some_result(const std::string& method, const std::vector<double>& errors, std::size_t none = 99) {
  BenchResult result;
  result.suite = "small";
  result.suite_digest = "0123";
  result.method = method;
  result.version = "v1; \"quoted\"\n";
  result.source = "ours";
  result.build = "0.1.0 abcd";
  result.command = "tumble bench " + method;
  result.date = "2026-01-31";
  for (std::size_t k = 0; k < errors.size(); ++k) {
    BenchDraw draw;
    draw.scenario = "hill";
    draw.seed = k == 1 ? 18446744073709551615u : k + 1;
    draw.group = k == 0 ? "mild" : "wild";
    draw.recording = "digest" + std::to_string(k);
    draw.status = errors[k] < 0.0 ? OutcomeStatus::crashed : OutcomeStatus::ok;
    if (errors[k] >= 0.0 && k != none) draw.values[kError] = errors[k];
    result.draws.push_back(std::move(draw));
  }
  return result;
}

}  // namespace tumble::scenarios::testing
