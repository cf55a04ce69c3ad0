// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/shrink.hpp"

/// The functions in hold_case.hpp handle named cases. A named case stores a failing simulated run and the expected
/// result of each method.
namespace tumble::scenarios {

/// Converts a shrunk run (simplified failing run) to a named case with the scenario name `name`. The named case expects
/// that `method` (a name for find_methods) fails. `command` is the command line that created the named case.
Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method, const Failure& failure,
                       const std::string& version, const std::string& command);

/// Returns the failure criterion of an expectation: the metric and its bound.
Failure failure_of(const Expectation& expected);

/// A failing case passes the check if its metric is within this factor of the accepted value.
inline constexpr double kCaseFactor = 2.0;

/// CaseResult is the result of comparing an outcome with the expectation of a named case.
struct CaseResult {
  std::string name, method;
  Expectation expected;
  OutcomeStatus status = OutcomeStatus::ok;
  std::optional<double> value;  ///< value of the metric that the expectation names
  bool fails = false;
  bool better = false;  ///< the method passes, or its error is below half of the accepted value; update the expectation
  std::string fault;    ///< why the check fails; empty if the check passes
};

/// Compares an outcome with the expectation of a named case. A method that is expected to pass must not fail. A method
/// that is expected to fail must have the accepted status, and a metric within the factor `kCaseFactor` of the accepted
/// value. An improvement also fails the check, so that the developer updates the accepted value.
CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome);

/// Returns the expectation with the status and metric of `outcome` as the accepted values.
Expectation accepted(const Expectation& expected, const Outcome& outcome);

/// Throws BadInput if a named case contains an unknown method, metric or status.
void require_known(const Scenario& scenario);

}  // namespace tumble::scenarios
