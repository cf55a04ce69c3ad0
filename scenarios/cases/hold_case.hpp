// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/cases/shrink.hpp"

/// Named cases: failing draws that are kept, and what is expected of methods on them.
namespace tumble::scenarios {

/// The case that a shrunk draw makes: `name` becomes the scenario's. It expects of `method`, a name for find_methods,
/// that it still fails. `command` made it.
Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method, const Failure& failure,
                       const std::string& version, const std::string& command);

/// What makes a run of the case fail.
Failure failure_of(const Expectation& expected);

/// How many times better or worse than accepted the metric of a case that still fails may be: beyond, somebody has to
/// look at it.
inline constexpr double kCaseFactor = 2.0;

/// One expectation of a case against an outcome.
struct CaseResult {
  std::string name, method;
  Expectation expected;
  OutcomeStatus status = OutcomeStatus::ok;
  std::optional<double> value;  ///< of the expected metric
  bool fails = false;
  bool better = false;  ///< it was to fail and does not, or by less than half: accept it
  std::string fault;    ///< what is wrong; empty when nothing is
};

/// Held on both sides. A case that is to hold fails the gate when it fails. A case that still fails has to fail as it
/// did, with the same status, its metric within `kCaseFactor` of the accepted: a cure fails the gate too, so that it is
/// accepted and held from then on.
CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome);

/// The expectation with what the outcome is as the accepted run.
Expectation accepted(const Expectation& expected, const Outcome& outcome);

/// Throws BadInput where a case expects something of a method, a metric or a status that there is not.
void require_known(const Scenario& scenario);

}  // namespace tumble::scenarios
