// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Expectation is the expected result of one method on a named case.
struct Expectation {
  std::string method;                ///< "slam/tumble"
  bool fails = false;                ///< whether the method is expected to fail
  std::string metric;                ///< metric to check in addition to status and verdicts; empty: none
  std::optional<double> worse_than;  ///< bound of the metric for a failure; empty: only status and verdicts count
  std::string status;                ///< status of the accepted run
  std::optional<double> drawn;       ///< metric of the run before shrinking
  std::optional<double> value;       ///< metric of the accepted run, if it has one
  bool operator==(const Expectation&) const = default;
};

/// NamedCase is the value of the key `case` in a file of scenarios/regressions: origin and expected results of one
/// simulated run. NamedCase contains methods, metrics and statuses as plain texts; the code in scenarios/cases checks
/// that they exist.
struct NamedCase {
  std::string scenario;    ///< scenario from which the case was drawn
  std::uint64_t seed = 0;  ///< seed of all random values that the listed numbers do not fix
  std::string version;     ///< version of the program that shrank the case
  std::string command;     ///< command that shrank the case
  std::vector<Expectation> expected;
  bool operator==(const NamedCase&) const = default;
};

}  // namespace tumble::scenarios
