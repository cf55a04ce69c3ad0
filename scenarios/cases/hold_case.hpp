// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/shrink.hpp"

namespace tumble::scenarios {

Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method,
                       const FailureGoal& failure, const std::string& version, const std::string& command);

FailureGoal failure_of(const Expectation& expected);

inline constexpr double kCaseFactor = 2.0;

struct CaseResult {
  std::string name, method;
  Expectation expected;
  OutcomeStatus status = OutcomeStatus::ok;
  std::optional<double> value;  ///< value of the metric that the expectation names
  bool fails = false;
  bool better = false;  ///< success, or half the accepted error
  std::string fault;    ///< reason if the check fails
};

/// Checks the outcome of a repeated run on which an estimator is known to fail. The check passes if the run fails again
/// with the accepted status, and if the ratio of the metric to its accepted value is at most `kCaseFactor`. The check
/// also fails if the method improves, so that a developer updates the accepted value.
CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome);

Expectation accepted(const Expectation& expected, const Outcome& outcome);

void require_known(const Scenario& scenario);

}  // namespace tumble::scenarios
