// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/failure_goal.hpp"

namespace tumble::scenarios {

struct TrueInput {
  std::string name;
  std::string doc;
  bool (*replace)(sim::Sensors& sensors, const sim::Truth& truth);
};

std::span<const TrueInput> true_inputs();

struct TriageRow {
  std::string input;  ///< "none": without true inputs
  std::string doc;
  Outcome outcome;
  bool fails = false;
};

struct TriageOptions {
  FailureGoal failure;
  double timeout_s = 300.0;  ///< time limit of one run
  std::function<void(const std::string& input)> on_run;
  std::function<void(const TriageRow&)> on_row;  ///< called after each row
};

/// Runs a method on the original sensor data, and then once per input, with only one input replaced by its true value.
/// Each run of the method has a separate process. If the method fails in every run, the cause is the method or the
/// scenario.
std::vector<TriageRow> triage(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                              const TriageOptions& options);

}  // namespace tumble::scenarios
