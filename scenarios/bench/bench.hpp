// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::scenarios {

/// Returns the name of the bench suite, for example "bench_rate_v1"; a changed suite gets a higher version number.
std::string bench_suite_name(Kind kind);

/// Returns a hash of the bench suite's scenarios, seeds, classes of runs and time limit; only results with equal
/// digests are comparable.
std::string bench_suite_digest(const Suite& suite);

/// Collects one method's results on a bench suite. Throws BadInput if a simulated run of the suite has no outcome. The
/// caller adds command line and date.
BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Adds published bench results to a database of measured results, without computing costs, because only costs from one
/// machine are comparable.
void add_published(std::span<const BenchResult> published, Results& results);

void require_of_suite(const BenchResult& result, const Suite& suite);

/// Returns the name of the first simulated run whose recordings differ between the results `a` and `b`; empty if all
/// recordings are equal.
std::string other_recording(const BenchResult& a, const BenchResult& b);

/// BenchCell contains one method's median of one metric over one class of simulated runs. Failed runs, and runs without
/// a value, rank worst. A run is skipped if another method completed the run without a value, for example because no
/// reading was clipped.
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite if half of the runs failed; NaN if no run counts
};

BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// BenchWins counts the simulated runs on which `result` is better than `baseline`, among the runs with values of both.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
