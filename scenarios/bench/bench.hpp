// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

/// The bench: fixed suites, one for each kind of method, on which anybody's method is held beside stored results.
namespace tumble::scenarios {

/// Name of the suite that methods of this kind are benched by: "bench_rate_v1". Another set of draws, another limit or
/// another class is another version.
std::string bench_suite_name(Kind kind);

/// What two results must agree in to be of one suite: digest of its draws with their classes and of its limit of time.
std::string bench_suite_digest(const Suite& suite);

/// What a sweep of the suite holds of one method; command and date are left to the caller. Throws BadInput when a draw
/// has no outcome.
BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Throws BadInput unless a result is of this suite, with all of its draws.
void require_of_suite(const BenchResult& result, const Suite& suite);

/// The first draw whose recording is not the same in both: they are then of two simulations, and are not compared.
/// Empty when there is none.
std::string other_recording(const BenchResult& a, const BenchResult& b);

/// One metric of one method over one class. A draw that did not end in `ok`, or has no value, ranks as the worst; one
/// on which another result says `ok` without a value (nothing was clipped) does not count.
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite when half of the draws are lost; NaN when none counts
};

/// `group` empty: all classes. `beside` are the results that are compared, this one among them or not.
BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// Draws on which `result` is better than `baseline`, of those that count for both.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
