// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/shrink.hpp"

/// hold_case.hpp handles named cases, which store a failing simulated run with the expected result of each method.
namespace tumble::scenarios {

/// Returns the named case of a shrunk run, with `name` as its scenario name. The named case states that `method` (a
/// name for find_methods) is expected to fail. `command` is the command line that created the case.
Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method, const Failure& failure,
                       const std::string& version, const std::string& command);

/// Returns the failure criteria that an expectation states.
Failure failure_of(const Expectation& expected);

/// kCaseFactor is the largest accepted factor between the measured and the accepted metric of a failing case.
inline constexpr double kCaseFactor = 2.0;

/// CaseResult is the result of comparing one expectation with an outcome.
struct CaseResult {
  std::string name, method;
  Expectation expected;
  OutcomeStatus status = OutcomeStatus::ok;
  std::optional<double> value;  ///< value of the expected metric
  bool fails = false;
  bool better = false;  ///< passes, or error below half; update the expectation
  std::string fault;    ///< description of the fault; empty if none
};

/// Checks that an outcome is neither worse nor better than expected. A case that is expected to pass must not fail. A
/// case that is expected to fail must have the accepted status and a metric within `kCaseFactor` of the accepted value.
/// An improvement also fails this check, so that the developer updates the accepted value.
CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome);

/// Returns the expectation with the status and value of this outcome as the accepted values.
Expectation accepted(const Expectation& expected, const Outcome& outcome);

/// Throws BadInput if a case names an unknown method, metric or status.
void require_known(const Scenario& scenario);

}  // namespace tumble::scenarios
