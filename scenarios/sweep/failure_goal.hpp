// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

bool is_failed_verdict(const Score& score);

/// FailureGoal defines the failure of a run by a metric that is worse than a limit. A run whose status is not ok also
/// fails. A search (`score`) does not count runs that are `rejected` or lack the metric. Triage, shrinking and named
/// cases (`holds`) count rejected runs and runs without the metric as failures.
struct FailureGoal {
  std::string metric;  ///< empty: only status and pass-fail metrics define a failure; not valid for a search
  double limit = 0.0;  ///< infinite: no value is worse
  bool operator==(const FailureGoal&) const = default;

  bool holds(const Outcome& outcome) const;
  /// Returns whether a value of the metric is worse than the limit; NaN is not worse.
  bool is_worse(double value) const;
  /// Returns the score of a run, which is larger for worse runs. A run with the status `rejected` or without the metric
  /// has the score -infinity; any other status except ok gives +infinity.
  double score(OutcomeStatus status, double value) const;
  /// Converts a score to the value of the metric; score and value have opposite signs if higher values are better.
  double value_at(double score) const;
  /// Returns the score at `limit`, clamped to finite numbers; a run fails if its score is larger.
  double bound() const;
  std::string text() const;
};

/// Parses "METRIC > VALUE" or, if higher values are better, "METRIC < VALUE". Throws BadInput for any other text, a
/// metric that methods of `kind` lack, or a sign (< or >) that makes better values fail.
FailureGoal parse_goal(const std::string& text, Kind kind);

}  // namespace tumble::scenarios
