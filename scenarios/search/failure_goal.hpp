// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"

namespace tumble::scenarios {

/// FailureGoal is the event whose probability a search estimates: the metric of a run is worse than a limit. A run also
/// fails if its status is neither ok nor `rejected`. A run whose result lacks the metric does not count as failed.
struct FailureGoal {
  std::string metric;
  double limit = 0.0;  ///< infinite: only runs whose status is not ok fail
  bool operator==(const FailureGoal&) const = default;

  /// Returns the score of a run, which is larger for worse runs. A run with the status `rejected` or without the metric
  /// has the score -infinity; any other status except ok gives +infinity.
  double score(OutcomeStatus status, double value) const;
  /// Converts a score to the value of the metric; score and value have opposite signs if higher values are better.
  double value_at(double score) const;
  /// Returns the score at `limit`, clamped to finite numbers; a run fails if its score is larger.
  double bound() const;
  /// Formats the goal as "METRIC > VALUE", or with "<" if higher values are better.
  std::string text() const;
};

/// Parses "METRIC > VALUE" or, if higher values are better, "METRIC < VALUE". Throws BadInput for any other text, a
/// metric that methods of `kind` lack, or a sign that selects better values.
FailureGoal parse_goal(const std::string& text, Kind kind);

}  // namespace tumble::scenarios
