// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::scenarios {

std::string bench_suite_name(Kind kind);

/// Only bench results with equal suite digests are comparable.
std::string bench_suite_digest(const Suite& suite);

BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Adds published results of a bench suite to a results database, without computing times. Only computing times from
/// one machine are comparable.
void add_published(std::span<const BenchResult> published, Results& results);

void require_of_suite(const BenchResult& result, const Suite& suite);

std::string other_recording(const BenchResult& a, const BenchResult& b);

/// In the median, a failed run counts as the worst value of the metric. bench_cell() skips a simulated run if `result`
/// or a method in `beside` completed the run without a value of the metric. For example, a run without clipped readings
/// has no error at clipped readings.
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite if half failed; NaN if no runs
};

BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// bench_wins() compares the simulated runs that `baseline` contains and bench_cell() does not skip. A failed run has
/// the worst value of the metric.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
