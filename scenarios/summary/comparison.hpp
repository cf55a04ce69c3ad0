// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/summary.hpp"

namespace tumble::scenarios {

/// Margin is the non-inferiority margin: the largest accepted amount by which a method may be worse than the reference
/// method. The margin is in the metric's unit, or a fraction of the reference method's value.
struct Margin {
  double value = 0.0;
  bool relative = false;
};

/// Returns by how much the metric value `own` is worse than the value `other` on a simulated run, minus the accepted
/// margin. The result is infinite if only the method with the value `own` failed, and 0 if both methods failed.
double worse_by(const MetricInfo& info, double own, double other, const Margin& allowed);

struct ComparisonOptions {
  std::vector<std::string> methods;  ///< empty: all methods without truth
  std::string against;               ///< empty: the section's reference method
  std::vector<std::string> metrics;  ///< empty: the headline metrics
  std::optional<Margin> margin;      ///< empty: no non-inferiority test
  double risk = 0.05;                ///< probability of any false result
  double power = 0.8;                ///< power for `pairs_needed`
};

enum class Finding { undecided, better, worse };
const char* to_string(Finding finding);

struct Contest {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method, against;
};

inline bool one_section(const Contest& a, const Contest& b) {
  return a.scenario == b.scenario && a.kind == b.kind && a.against == b.against;
}

/// MetricComparison compares the values of one metric of two methods. A failed run counts as the worst value of the
/// metric. If both methods failed or have equal values on a run, neither method is better.
struct MetricComparison {
  Contest contest;
  std::string metric;
  std::int64_t pairs = 0, better = 0, worse = 0;
  double median = 0.0, against_median = 0.0;
  /// Median of the paired differences (value of the method minus value of the reference), with a bias-corrected
  /// bootstrap interval (BCa). For a metric with a target, the differences are differences of the distances from the
  /// target.
  Interval difference{};
  double sign_chance = 1.0, rank_chance = 1.0;  ///< two-sided p-values
  double corrected = 1.0;                       ///< `rank_chance` after Holm's correction
  Finding finding = Finding::undecided;         ///< conclusion from `corrected`
  double not_inferior_chance = 1.0;             ///< one-sided p-value of inferiority
  double not_inferior_corrected = 1.0;          ///< after Holm's correction
  bool not_inferior = false;                    ///< `not_inferior_corrected` is below the risk
  double pairs_needed = 0.0;                    ///< may be infinite
};

/// FailureComparison compares the failures of two methods. A failure is a run whose status is not ok, or a run with the
/// value 1 of a pass-fail metric. A run whose status is not ok also fails each pass-fail metric.
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

/// Compares each method with the reference method. A metric without a better direction, for example a cost, is compared
/// only if the caller names the metric. For a metric without a better direction, the finding is always
/// Finding::undecided.
Comparison compare(const Summary& summary, const ComparisonOptions& options);

}  // namespace tumble::scenarios
