// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

bool is_failed_verdict(const Score& score);

/// FailureGoal defines when a run counts as failed: a metric is worse than a limit, or the status is not ok. A search
/// for failures uses `score`, which does not count `rejected` runs and runs without the metric. Triage, shrinking and
/// named cases use `holds`, which counts `rejected` runs and runs without the metric as failures.
struct FailureGoal {
  std::string metric;  ///< empty: only status and pass-fail metrics define a failure; not valid for a search
  double limit = 0.0;  ///< infinite: no value is worse
  bool operator==(const FailureGoal&) const = default;

  bool holds(const Outcome& outcome) const;
  /// Returns true if a value of the metric is worse than the limit; NaN does not count as worse.
  bool is_worse(double value) const;
  /// Returns the score of a run; a worse run has a larger score. The score is -infinity if the status is `rejected` or
  /// the metric is missing, and +infinity for any other status except ok.
  double score(OutcomeStatus status, double value) const;
  /// Converts a score to the value of the metric. If higher values of the metric are better, score and value have
  /// opposite signs.
  double value_at(double score) const;
  /// Returns the score at `limit`, clamped to finite numbers. A run fails if the score of the run is larger than
  /// bound().
  double bound() const;
  std::string text() const;
};

/// Parses a text "METRIC > VALUE" or, if higher values are better, "METRIC < VALUE". Throws BadInput for any other
/// text, for a metric that does not exist for methods of `kind`, or for a sign (< or >) that would make better values
/// fail.
FailureGoal parse_goal(const std::string& text, Kind kind);

}  // namespace tumble::scenarios
