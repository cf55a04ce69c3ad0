// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

/// One input of a method, and how it is replaced by its truth. One line of registration each.
struct TrueInput {
  std::string name;
  std::string doc;
  /// Replaces it in `sensors`. False when there is nothing to replace: the recording has no such input, or it is true
  /// already. Both belong to one recording.
  bool (*replace)(sim::Sensors& sensors, const sim::Truth& truth);
};

/// All inputs; the last one is all of them at once.
std::span<const TrueInput> true_inputs();

/// What makes an outcome a failure: a status that is not ok, a verdict against it (`map_failed`), or a metric beyond a
/// limit.
struct Failure {
  std::string metric;  ///< empty: status and verdicts alone
  double limit = 0.0;  ///< above it, or below it where higher is better
  bool holds(const Outcome& outcome) const;
};

struct TriageRow {
  std::string input;  ///< what was replaced; "none" for the outcome as it was
  std::string doc;
  Outcome outcome;
  bool fails = false;
};

struct TriageOptions {
  Failure failure;
  double timeout_s = 300.0;  ///< for one run of the method
  std::function<void(const std::string& input)> on_run;
  std::function<void(const TriageRow&)> on_row;  ///< as each ends
};

/// Runs a method on a draw as it is, then with one input after the other replaced by its truth, each in a process of
/// its own, all scored against the same truth and the sensors as they were. The first row is the draw as it is. The
/// method itself is untouched: what an input's truth cannot cure lies in the method or in the scenario. Throws what
/// simulate_draw throws; BadInput when the method does not apply to the scenario.
std::vector<TriageRow> triage(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                              const TriageOptions& options);

}  // namespace tumble::scenarios
