// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/shrink.hpp"

/// The functions in hold_case.hpp handle named cases: each named case stores a failing simulated run and the expected
/// result of each method.
namespace tumble::scenarios {

/// Converts a shrunk run to a named case with `name` as its scenario name. The named case states that `method` (a name
/// for find_methods) is expected to fail. The text `command` is the command line that created the named case.
Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method, const Failure& failure,
                       const std::string& version, const std::string& command);

/// Returns the failure criteria of an expectation.
Failure failure_of(const Expectation& expected);

/// A failing case may differ from its accepted metric by at most the factor kCaseFactor.
inline constexpr double kCaseFactor = 2.0;

/// CaseResult is the result of comparing an outcome with the expectation of a named case.
struct CaseResult {
  std::string name, method;
  Expectation expected;
  OutcomeStatus status = OutcomeStatus::ok;
  std::optional<double> value;  ///< value of the expected metric
  bool fails = false;
  bool better = false;  ///< passes, or error below half; update the expectation
  std::string fault;    ///< description of the fault; empty if none
};

/// Checks that an outcome is neither worse nor better than the expectation of a named case. A method that is expected
/// to pass must not fail. A method that is expected to fail must have the accepted status and a metric within
/// `kCaseFactor` of the accepted value. An improvement also fails the check, so that the developer updates the accepted
/// value.
CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome);

/// Returns the expectation with the status and metric of `outcome` as the accepted values.
Expectation accepted(const Expectation& expected, const Outcome& outcome);

/// Throws BadInput if a named case contains an unknown method, metric or status.
void require_known(const Scenario& scenario);

}  // namespace tumble::scenarios
