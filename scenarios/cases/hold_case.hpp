// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/shrink.hpp"

/// Named cases: stored failing draws with the expected results of methods.
namespace tumble::scenarios {

/// Returns the case of a shrunk draw, with `name` as its scenario name. It expects that `method` (a name for
/// find_methods) still fails. `command` is the command that created it.
Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method, const Failure& failure,
                       const std::string& version, const std::string& command);

/// Returns the failure criteria of an expectation.
Failure failure_of(const Expectation& expected);

/// Allowed factor between the metric of a case that still fails and its accepted value.
inline constexpr double kCaseFactor = 2.0;

/// Result of one expectation on an outcome.
struct CaseResult {
  std::string name, method;
  Expectation expected;
  OutcomeStatus status = OutcomeStatus::ok;
  std::optional<double> value;  ///< value of the expected metric
  bool fails = false;
  bool better = false;  ///< no longer fails, or by less than half; the expectation should be updated
  std::string fault;    ///< description of the fault; empty if none
};

/// Checks an outcome in both directions. A case that should pass must not fail. A failing case must fail with the same
/// status and its metric within `kCaseFactor` of the accepted value. An improvement thus also fails the gate, so that
/// it is accepted and then kept.
CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome);

/// Returns the expectation with this outcome as the accepted result.
Expectation accepted(const Expectation& expected, const Outcome& outcome);

/// Throws BadInput if a case names an unknown method, metric or status.
void require_known(const Scenario& scenario);

}  // namespace tumble::scenarios
