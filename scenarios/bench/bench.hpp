// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

/// The functions in bench.hpp compare stored results of methods on fixed suites of simulated runs. Each kind of method
/// (rate, attitude, position, slam) has one suite.
namespace tumble::scenarios {

/// Returns the name of the bench suite of a kind of method, for example "bench_rate_v1". The version in the name
/// increases if the suite's simulated runs, limits or classes of runs change.
std::string bench_suite_name(Kind kind);

/// Returns a hash of the suite's scenarios, seeds, classes of runs and time limit. Only results with equal suite
/// digests are comparable.
std::string bench_suite_digest(const Suite& suite);

/// Collects the results of one method from a stored sweep over the bench suite. The caller adds command line and date.
/// Throws BadInput if a simulated run of the suite has no outcome.
BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Adds published bench results to a database of measured results, each with a note of its build and date. Computing
/// costs are omitted, because only costs from the same machine are comparable. The database must not contain other
/// results of the published methods.
void add_published(std::span<const BenchResult> published, Results& results);

/// Throws BadInput if the result belongs to another suite or lacks the outcome of a simulated run.
void require_of_suite(const BenchResult& result, const Suite& suite);

/// Returns the name of the first simulated run whose recordings differ between the results `a` and `b`; empty if all
/// recordings are equal. Bench results are comparable only if all recordings are equal.
std::string other_recording(const BenchResult& a, const BenchResult& b);

/// BenchCell contains one method's median of one metric over one class of simulated runs, and the number of lost runs.
/// Runs with a status other than `ok`, or without a value, rank worst. A run is skipped if another method completed it
/// without a value, for example because no reading was clipped.
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite if half of the runs failed; NaN if no run counts
};

/// Computes the median of `result` for one metric. An empty `group` selects all classes of simulated runs. `beside`
/// contains the results of other methods, and may include `result`.
BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// BenchWins counts the simulated runs on which `result` is better than `baseline`. Only runs with a value for both
/// methods count.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
