// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

/// The functions in bench.hpp compare the stored results of methods on fixed suites of simulated runs. Each kind of
/// method (rate, attitude, position, slam) has one suite.
namespace tumble::scenarios {

/// Returns the name of the bench suite of a kind of method, for example "bench_rate_v1". The version in the name
/// increases if the suite's simulated runs, limits or classes of runs change.
std::string bench_suite_name(Kind kind);

/// Returns a hash of the suite's scenarios, seeds, classes of runs and time limit. Only results with equal suite
/// digests are comparable.
std::string bench_suite_digest(const Suite& suite);

/// Collects the results of one method from a stored sweep over the bench suite. The caller adds the command line and
/// the date to the result. Throws BadInput if a simulated run of the suite has no outcome.
BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Adds published bench results to a database of measured results, each with a note of its build and date. The
/// computing cost is omitted, because only costs from the same machine are comparable. The database must not contain
/// other results of the published methods.
void add_published(std::span<const BenchResult> published, Results& results);

/// Throws BadInput unless the result belongs to this suite and has an outcome for every simulated run.
void require_of_suite(const BenchResult& result, const Suite& suite);

/// Returns the first simulated run whose recordings differ between the results `a` and `b`, or an empty text. Two bench
/// results are comparable only if all recordings are equal.
std::string other_recording(const BenchResult& a, const BenchResult& b);

/// BenchCell contains the median of one metric over one class of simulated runs for one method, and the method's rank.
/// Simulated runs whose status is not `ok`, or that have no value of the metric, rank worst. A simulated run is skipped
/// if another method completed the run without a value, for example because no reading was clipped.
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite if half of the runs failed; NaN without runs
};

/// Computes the median and rank of `result` for one metric. An empty `group` selects all classes of simulated runs. The
/// list `beside` contains the results to compare with, and may include `result`.
BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// BenchWins is the number of simulated runs on which `result` is better than `baseline`. Only runs that have a value
/// for both methods count.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
