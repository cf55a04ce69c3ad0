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

/// Returns a hash of the name, time limit and runs of a suite. The bench results of two methods are comparable only if
/// the hashes of their suites are equal.
std::string bench_suite_digest(const Suite& suite);

BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Adds published results of a bench suite to a results database. Computing times are omitted, because computing times
/// from different machines are not comparable.
void add_published(std::span<const BenchResult> published, Results& results);

void require_of_suite(const BenchResult& result, const Suite& suite);

std::string other_recording(const BenchResult& a, const BenchResult& b);

/// bench_cell() computes the median of a metric over the runs, in which a failed run counts as the worst value of the
/// metric. A simulated run is skipped if `result` or a method in `beside` completed this run without a value of the
/// metric.
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite if half failed; NaN if no runs
};

BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// bench_wins() compares two methods on the simulated runs that `baseline` contains and that bench_cell() does not
/// skip.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
