// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

/// TrueInput is one input of a method, with a function that replaces it by its true value. The table in true_inputs.cpp
/// lists the inputs.
struct TrueInput {
  std::string name;
  std::string doc;
  /// Replaces the input in `sensors`, which belong to `truth`, by its true value. Returns false if the recording lacks
  /// the input or it is already exact.
  bool (*replace)(sim::Sensors& sensors, const sim::Truth& truth);
};

/// Returns all inputs that can be replaced by their true values; the last entry replaces all at once.
std::span<const TrueInput> true_inputs();

/// Returns true if the score is a verdict that the run failed (for example `map_failed`). Unranked verdicts only
/// describe the run.
bool is_failed_verdict(const Score& score);

/// Failure contains the criteria of a failure: a status other than ok, a failing verdict (`map_failed`), or a metric
/// worse than a limit.
struct Failure {
  std::string metric;  ///< empty: only status and verdicts count
  double limit = 0.0;  ///< upper limit, or lower limit if higher values are better
  bool holds(const Outcome& outcome) const;
};

struct TriageRow {
  std::string input;  ///< replaced input; "none" for the outcome without true inputs
  std::string doc;
  Outcome outcome;
  bool fails = false;
};

struct TriageOptions {
  Failure failure;
  double timeout_s = 300.0;  ///< time limit of one run
  std::function<void(const std::string& input)> on_run;
  std::function<void(const TriageRow&)> on_row;  ///< called after each row
};

/// Runs a method on the original sensor data, then with each input replaced by its true value, in separate processes.
/// All runs are scored against the same truth. The first result is that of the original sensor data. If no true input
/// prevents a failure, the cause is the method or the scenario. Throws the exceptions of simulate_draw, and BadInput if
/// the method cannot run on the scenario.
std::vector<TriageRow> triage(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                              const TriageOptions& options);

}  // namespace tumble::scenarios
