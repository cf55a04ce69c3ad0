// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/keep.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

struct DrawTriage {
  DrawName draw;
  std::vector<TriageRow> rows;  ///< first: without true inputs
  std::string error_code;       ///< simulation impossible, process died, time-out
};

std::vector<DrawName> draws_of(const DataRoot& data, const Suite& suite, const Method& method);

std::set<DrawName> failed_draws(const Results& results, const Method& method, const FailureGoal& failure);

struct SuiteTriageOptions {
  TriageOptions triage;                  ///< without callbacks
  int jobs = 1;                          ///< number of processes
  double memory_mib = kWorkerMemoryMib;  ///< memory limit (RLIMIT_DATA) of each process
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const DrawTriage&)> on_draw;  ///< called after each simulated run
};

/// Performs the triage of each simulated run in a separate process with a time limit. The triage replaces one input of
/// a method at a time by the true value. If the process dies or times out, DrawTriage contains the completed results
/// and an error message.
std::vector<DrawTriage> triage_draws(const DataRoot& data, std::span<const DrawName> draws, const Method& method,
                                     const SuiteTriageOptions& options);

}  // namespace tumble::scenarios
