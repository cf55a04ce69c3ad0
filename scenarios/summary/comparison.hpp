// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/summary.hpp"

/// The functions in comparison.hpp compare two methods on the same simulated runs: size and significance of the
/// difference (docs/maths/statistics.md).
namespace tumble::scenarios {

/// Margin is the largest accepted deficit of a method (non-inferiority margin). The margin is in the unit of the
/// metric, or a fraction of the reference method's value on the same simulated run.
struct Margin {
  double value = 0.0;
  bool relative = false;
};

/// Returns how much worse the value `own` is than `other` on a simulated run, minus the margin. The result is negative
/// if `own` is worse by less than the margin. A negative margin requires an improvement. The result is infinite if only
/// `own` belongs to a failed run, and 0 if both runs failed.
double worse_by(const MetricInfo& info, double own, double other, const Margin& allowed);

struct ComparisonOptions {
  std::vector<std::string> methods;  ///< "rate/tumble" or "tumble"; empty: all that need no truth
  std::string against;               ///< empty: the baseline of each section
  std::vector<std::string> metrics;  ///< empty: the headline metrics of each kind
  std::optional<Margin> margin;      ///< empty: no non-inferiority test
  double risk = 0.05;                ///< probability of any false finding in one table
  double power = 0.8;                ///< power for `pairs_needed`
};

enum class Finding { undecided, better, worse };
const char* to_string(Finding finding);

/// Contest names the scenario, the kind and the two methods of a comparison.
struct Contest {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, against;
};

/// Returns whether two comparisons have the same scenario, kind and reference method.
inline bool one_section(const Contest& a, const Contest& b) {
  return a.scenario == b.scenario && a.kind == b.kind && a.against == b.against;
}

/// MetricComparison compares one metric over the simulated runs on which both methods have a value. Failed runs get the
/// worst value (`worst_value`). If both runs failed or are equal, neither method is better.
struct MetricComparison {
  Contest contest;
  std::string metric;
  std::int64_t pairs = 0, better = 0, worse = 0;
  double median = 0.0, against_median = 0.0;
  /// The member `difference` is the median of the paired differences, method minus reference, with its BCa interval.
  /// For a metric with a target, each difference is between two distances from the target (`how_bad`).
  Interval difference{};
  double sign_chance = 1.0, rank_chance = 1.0;  ///< two-sided p-values
  double corrected = 1.0;                       ///< `rank_chance` corrected by Holm over all metrics of the comparison
  Finding finding = Finding::undecided;         ///< from `corrected`
  double not_inferior_chance = 1.0;             ///< one-sided p-value for being worse than the margin
  double not_inferior_corrected = 1.0;          ///< corrected by Holm
  bool not_inferior = false;                    ///< `not_inferior_corrected` is below the risk
  double pairs_needed = 0.0;  ///< number of pairs for the risk divided by the number of tests; may be infinite
};

/// FailureComparison compares the failures of two methods. A simulated run fails if its status is not ok or a pass-fail
/// metric is 1. A failed run also counts as a failure in each pass-fail metric.
struct FailureComparison {
  Contest contest;
  std::string what;  ///< "not ok", "map_failed"
  std::int64_t pairs = 0, only_method = 0, only_against = 0;
  Interval share{}, against_share{};  ///< Clopper and Pearson, 95 %
  double chance = 1.0, corrected = 1.0;
  Finding finding = Finding::undecided;
  double pairs_needed = 0.0;
};

struct Comparison {
  std::vector<MetricComparison> metrics;
  std::vector<FailureComparison> failures;
};

/// Compares the methods of a summary with their reference methods, in the order of the summary's sections. Costs and
/// other unranked metrics are compared only if the caller names them, and give no finding. Throws BadInput for methods
/// or metrics that the results do not contain; the message suggests the nearest name. Throws BadInput for a risk, power
/// or margin out of range.
Comparison compare(const Summary& summary, const ComparisonOptions& options);

}  // namespace tumble::scenarios
