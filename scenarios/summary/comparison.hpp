// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/summary.hpp"

/// Two methods on the same draws: by how much one is better, and how sure that is (docs/maths/statistics.md).
namespace tumble::scenarios {

/// How much worse still counts as no worse: in the metric's unit, or as a share of the other's value on the same draw.
struct Margin {
  double value = 0.0;
  bool relative = false;
};

/// How much worse `own` is than `other` on a draw, beyond what is allowed: below 0 where it is not; a negative margin
/// asks it to be better by as much. Infinite where one of the two failed, 0 where both did.
double worse_by(const MetricInfo& info, double own, double other, const Margin& allowed);

struct ComparisonOptions {
  std::vector<std::string> methods;  ///< "rate/tumble" or "tumble"; empty: all that need no truth
  std::string against;               ///< empty: the baseline of each section
  std::vector<std::string> metrics;  ///< empty: the headline ones of each kind
  std::optional<Margin> margin;      ///< none: non-inferiority is not asked
  double risk = 0.05;                ///< of any false verdict among those of one table
  double power = 0.8;                ///< that `pairs_needed` are to have
};

enum class Finding { undecided, better, worse };
const char* to_string(Finding finding);

/// What is compared with what.
struct Contest {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, against;
};

/// Whether both are of one section of the results, and against the same method.
inline bool one_section(const Contest& a, const Contest& b) {
  return a.scenario == b.scenario && a.kind == b.kind && a.against == b.against;
}

/// One metric over the draws of which both have a value, a failed run ranking as the worst (`worst_value`); where both
/// failed, and where they are equal, neither is better.
struct MetricComparison {
  Contest contest;
  std::string metric;
  std::int64_t pairs = 0, better = 0, worse = 0;
  double median = 0.0, against_median = 0.0;
  /// Median of the pairs' differences, method less other, with its BCa interval; of a metric with a target of the
  /// differences of the distances from it (`how_bad`).
  Interval difference{};
  double sign_chance = 1.0, rank_chance = 1.0;  ///< two-sided
  double corrected = 1.0;                       ///< `rank_chance` by Holm, over all metrics of the comparison
  Finding finding = Finding::undecided;         ///< by `corrected`
  double not_inferior_chance = 1.0;             ///< one-sided, of being worse by the margin; NaN without a margin
  double not_inferior_corrected = 1.0;          ///< by Holm
  bool not_inferior = false;                    ///< by `not_inferior_corrected`: shown to be no worse by the margin
  double pairs_needed = 0.0;  ///< in all, at the risk over the number of tests; infinite: no number would do
};

/// Draws on which a run is not ok, or on which a verdict is against it; a failed run counts as condemned.
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

/// In the order of the summary's sections. Costs and other metrics without a contest are compared where they are named,
/// with no finding. Throws BadInput: a method or metric that the results do not hold (the nearest named), risk, power
/// or margin beyond their bounds.
Comparison compare(const Summary& summary, const ComparisonOptions& options);

}  // namespace tumble::scenarios
