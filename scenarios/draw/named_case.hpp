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
  std::string metric;                ///< checked in addition to the status
  std::optional<double> worse_than;  ///< the check fails above this value
  std::string status;                ///< status of the method on the accepted run
  std::optional<double> drawn;       ///< value of the metric before shrinking
  std::optional<double> value;       ///< on the accepted run
  bool operator==(const Expectation&) const = default;
};

/// NamedCase describes a simulated run on which a method failed, and the results that are expected: the key `case` in a
/// file of scenarios/regressions.
struct NamedCase {
  std::string scenario;    ///< scenario of the original run
  std::uint64_t seed = 0;  ///< for values that the file omits
  std::string version;     ///< version of the program that simplified the run
  std::string command;     ///< command that simplified the run
  std::vector<Expectation> expected;
  bool operator==(const NamedCase&) const = default;
};

}  // namespace tumble::scenarios
