// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// What one method did on a named case when that was accepted.
struct Expectation {
  std::string method;                ///< "slam/tumble"
  bool fails = false;                ///< still, or not (any more)
  std::string metric;                ///< looked at beside status and verdicts; empty: none
  std::optional<double> worse_than;  ///< a run fails where the metric is worse than this; none: on status and verdicts
  std::string status;                ///< of the accepted run, as results have it
  std::optional<double> drawn;       ///< the metric on the draw before it was shrunk
  std::optional<double> value;       ///< the metric of the accepted run; none where it has none
  bool operator==(const Expectation&) const = default;
};

/// The key `case` of a file in scenarios/regressions: what it says beside the numbers of its one draw. Methods,
/// metrics and statuses are texts here; whoever holds a run to them (scenarios/cases) asks whether they exist.
struct NamedCase {
  std::string scenario;    ///< that it was drawn from
  std::uint64_t seed = 0;  ///< what is random beyond the numbers belongs to it
  std::string version;     ///< of the program that shrank it
  std::string command;     ///< that did
  std::vector<Expectation> expected;
  bool operator==(const NamedCase&) const = default;
};

}  // namespace tumble::scenarios
