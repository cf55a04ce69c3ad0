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

/// Triage of many draws: which input's truth matters most over a suite.
namespace tumble::scenarios {

/// A draw as triage left it.
struct DrawTriage {
  DrawName draw;
  std::vector<TriageRow> rows;  ///< as of triage(); the first is the draw as it is
  std::string trouble;          ///< why there are none, or not all: it cannot be simulated, its process died, was late
};

/// The draws of the suite whose robots the method is made for, seeds outermost, as a sweep has them. Throws
/// BadInput where a sweep would not take the suite's seeds.
std::vector<DrawName> draws_of(const DataRoot& data, const Suite& suite, const Method& method);

/// The draws on which results have the method failing, plain ones alone.
std::set<DrawName> failed_draws(const Results& results, const Method& method, const Failure& failure);

struct SuiteTriageOptions {
  TriageOptions triage;                  ///< its `on_run` and `on_row` are not called
  int jobs = 1;                          ///< processes
  double memory_mib = kWorkerMemoryMib;  ///< of data (RLIMIT_DATA), of a draw's process and of each of its runs
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const DrawTriage&)> on_draw;  ///< as each ends
};

/// Triage of each draw in a process of its own, which may hold `memory_mib` and take as long as its runs may and two
/// more: one that dies or is late leaves the rows that it has told, and why there are no more. In the order of `draws`,
/// whatever the number of jobs; shorter when stopped. Throws BadInput where a scenario cannot be read, where the memory
/// is no amount, and where not even one process can be made.
std::vector<DrawTriage> triage_draws(const DataRoot& data, std::span<const DrawName> draws, const Method& method,
                                     const SuiteTriageOptions& options);

}  // namespace tumble::scenarios
