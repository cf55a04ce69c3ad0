// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/bench/bench_result.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

/// Compares methods with stored results on fixed suites, one per kind of method.
namespace tumble::scenarios {

/// Returns the name of the bench suite of a kind: "bench_rate_v1". A change of draws, limits or classes gets a new
/// version.
std::string bench_suite_name(Kind kind);

/// Returns the digest of the suite's draws with classes and its time limit. Only results with equal digests are
/// comparable.
std::string bench_suite_digest(const Suite& suite);

/// Collects the results of one method from a sweep of the suite, except command and date. Throws BadInput if a draw has
/// no outcome.
BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method);

/// Throws BadInput unless the result belongs to this suite and has all its draws.
void require_of_suite(const BenchResult& result, const Suite& suite);

/// Returns the first draw with different recordings in both results, which are then not comparable; empty if none.
std::string other_recording(const BenchResult& a, const BenchResult& b);

/// One metric of one method over one class. Draws that are not `ok` or have no value rank worst. A draw does not count
/// if another result is `ok` without a value (nothing clipped).
struct BenchCell {
  std::size_t draws = 0, lost = 0;
  double median = 0.0;  ///< infinite if half of the draws failed; NaN without draws
};

/// `group` empty: all classes. `beside`: the compared results, with or without this one.
BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside);

/// Draws on which `result` is better than `baseline`, among those that count for both.
struct BenchWins {
  std::size_t better = 0, draws = 0;
};
BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside);

}  // namespace tumble::scenarios
