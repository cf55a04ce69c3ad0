// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

struct TrueInput {
  std::string name;
  std::string doc;
  bool (*replace)(sim::Sensors& sensors, const sim::Truth& truth);
};

std::span<const TrueInput> true_inputs();

bool is_failed_verdict(const Score& score);

struct Failure {
  std::string metric;  ///< empty: only status and verdicts
  double limit = 0.0;  ///< lower limit if higher is better
  bool holds(const Outcome& outcome) const;
};

struct TriageRow {
  std::string input;  ///< "none": without true inputs
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

/// Runs a method on the original sensor data, and then once per input, with only this input replaced by its true value.
/// Each run has a separate process. If the method fails in every run, the cause is the method or the scenario.
std::vector<TriageRow> triage(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
                              const TriageOptions& options);

}  // namespace tumble::scenarios
