// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/drawn_numbers.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/search/input_shift.hpp"
#include "scenarios/search/splitting.hpp"
#include "scenarios/sweep/failure_goal.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::scenarios {

/// Key for the runs of a failure search in the results database; the corresponding value is the index of the run.
inline constexpr const char* kSearchRun = "search.run";

struct SearchOptions {
  std::size_t population = 50, budget = 1000;  ///< as in SplittingOptions
  std::uint64_t seed = 1;                      ///< seed of the search
  double timeout_s = 300.0;                    ///< time limit of one method run
  int jobs = 1;                                ///< number of processes
  double memory_mib = kWorkerMemoryMib;        ///< memory limit (RLIMIT_DATA) of each process
  const std::atomic<bool>* stop = nullptr;
  std::function<void(std::size_t runs, std::size_t failures)> on_runs;
};

/// FoundFailure is a simulated run on which the method fails. `distance` is the norm of the standard normal numbers
/// from which the run's parameters were computed. The run with the smallest distance has the largest probability
/// density.
struct FoundFailure {
  std::size_t run = 0;  ///< index of the run
  double distance = 0.0;
  OutcomeStatus status = OutcomeStatus::ok;
  double value = 0.0;  ///< value of the metric; NaN if it is missing
  Scenario scenario;   ///< scenario with constant parameters
  std::uint64_t seed = 0;
};

struct SearchResult {
  SplittingResult splitting;
  std::size_t failures = 0, rejected = 0;  ///< runs that fail, and runs that could not be simulated
  std::vector<FoundFailure> likely;  ///< per initial draw, the failing copy with the smallest distance, smallest first
  FoundFailure worst;                ///< run with the largest score, of equal runs that with the smallest distance
  std::vector<InputShift> shifts;    ///< of the failing runs after the last step; without failing runs, of all runs
};

/// Returns the names of the random streams of a scenario, as in sim::Situation: the world and each sensor.
std::vector<std::string> stream_names(const Scenario& scenario);

/// Returns a scenario with constant parameters. The standard normal numbers of `point` are converted to parameter
/// values by the quantiles of the scenario's distributions (number_at). The seeds of `point` become the seeds of the
/// random streams.
Scenario scenario_at(const Scenario& scenario, std::span<const DrawnNumber> numbers, const SplittingPoint& point);

/// Estimates the probability of a failure by adaptive multilevel splitting over all random parameters of the scenario
/// and the seed of each random stream (splitting.hpp). Each run is simulated and estimated in a separate process, and
/// its result is stored in the database `results`. If the database contains runs of an interrupted search with equal
/// options, the search continues after these runs. The estimated probability does not depend on the number of
/// processes.
///
/// Throws BadInput in each of these cases:
/// - The options are invalid.
/// - The scenario has no random parameters.
/// - The method cannot process the scenario.
/// - `results` contains another search on this scenario and method.
/// - The operating system killed a run.
SearchResult search_failures(const DataRoot& data, const Scenario& scenario, const Method& method,
                             const FailureGoal& goal, Results& results, const SearchOptions& options);

}  // namespace tumble::scenarios
