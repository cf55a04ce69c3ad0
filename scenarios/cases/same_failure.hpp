// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/sweep/failure_goal.hpp"

namespace tumble::scenarios {

/// SameFailure decides whether a run fails in the same way as an earlier run. A run without a value of the metric that
/// defines the failure counts as a success.
class SameFailure {
 public:
  SameFailure(const FailureGoal& failure, const Outcome& outcome);

  bool holds(const Outcome& outcome) const;
  std::string describe() const;
  const std::string& metric() const { return goal_.metric; }

 private:
  OutcomeStatus status_;
  FailureGoal goal_;
};

}  // namespace tumble::scenarios
