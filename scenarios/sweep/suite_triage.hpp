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

/// The functions in suite_triage.hpp run the triage for many simulated runs, to find which true input helps most over a
/// suite.
namespace tumble::scenarios {

/// DrawTriage is the triage result of one simulated run: outcomes with true inputs.
struct DrawTriage {
  DrawName draw;
  std::vector<TriageRow> rows;  ///< rows of triage(); the first is the unmodified run
  std::string error_code;       ///< why rows are missing: simulation impossible, process died or timed out
};

/// Returns the scenarios and seeds of the suite whose robots the method supports. The order of the runs is that of a
/// sweep, with seeds as the outer loop. Throws BadInput if the seeds are invalid.
std::vector<DrawName> draws_of(const DataRoot& data, const Suite& suite, const Method& method);

/// Returns the unmodified simulated runs in `results` on which the method failed.
std::set<DrawName> failed_draws(const Results& results, const Method& method, const Failure& failure);

struct SuiteTriageOptions {
  TriageOptions triage;                  ///< `on_run` and `on_row` are not called
  int jobs = 1;                          ///< processes
  double memory_mib = kWorkerMemoryMib;  ///< memory limit (RLIMIT_DATA) of each process of a run
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const DrawTriage&)> on_draw;  ///< called after each draw
};

/// Runs the triage of each simulated run in a separate process. The time limit of the process is that of its method
/// runs plus two further runs, and its memory limit is `memory_mib`. If the process of a run dies or times out, its
/// results so far are kept, with an error. The results are in the order of `draws`; the list is shorter if the triage
/// was stopped. Throws BadInput for an unreadable scenario, an invalid memory limit, or if no process can be started.
std::vector<DrawTriage> triage_draws(const DataRoot& data, std::span<const DrawName> draws, const Method& method,
                                     const SuiteTriageOptions& options);

}  // namespace tumble::scenarios
