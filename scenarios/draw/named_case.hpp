// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble::scenarios {

struct Expectation {
  std::string method;                ///< "slam/tumble"
  bool fails = false;                ///< true: the method is expected to fail
  std::string metric;                ///< metric that is checked in addition to status and verdicts; empty: none
  std::optional<double> worse_than;  ///< the run fails if the metric is worse; empty: only status and verdicts count
  std::string status;                ///< status of the method on the accepted run
  std::optional<double> drawn;       ///< value of the metric before shrinking
  std::optional<double> value;       ///< value of the metric on the accepted run, if it exists
  bool operator==(const Expectation&) const = default;
};

/// NamedCase is the origin of one simulated run and the expected results of methods: the value of the key `case` in a
/// file of scenarios/regressions.
struct NamedCase {
  std::string scenario;    ///< scenario that contains the original run
  std::uint64_t seed = 0;  ///< seed of all random values that the file does not fix
  std::string version;     ///< version of the program that simplified the run
  std::string command;     ///< command that simplified the run
  std::vector<Expectation> expected;
  bool operator==(const NamedCase&) const = default;
};

}  // namespace tumble::scenarios
