// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/method.hpp"
#include "scenarios/scoring/outcome_status.hpp"

namespace tumble::scenarios {

/// FailureGoal is the event whose probability a search estimates: the metric of a run is worse than a limit. Runs whose
/// status is not ok are worse than each limit. A run without the metric does not fail.
struct FailureGoal {
  std::string metric;
  double limit = 0.0;  ///< infinite: only runs whose status is not ok fail
  bool operator==(const FailureGoal&) const = default;

  /// Returns the score, which is larger for worse runs. It is infinite for a status other than ok, and minus infinity
  /// for a rejected run and without the metric.
  double score(OutcomeStatus status, double value) const;
  /// Returns the value of the metric at a score.
  double value_at(double score) const;
  /// Returns the finite score that a failing run exceeds.
  double bound() const;
  /// Formats the goal as "METRIC > VALUE", or with "<" if higher values are better.
  std::string text() const;
};

/// Parses "METRIC > VALUE" or, if higher values are better, "METRIC < VALUE". Throws BadInput for another form, an
/// unknown metric of the method's kind, or the wrong direction.
FailureGoal parse_goal(const std::string& text, Kind kind);

}  // namespace tumble::scenarios
