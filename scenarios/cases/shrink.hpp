// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/triage.hpp"

/// The function `shrink` shortens and simplifies a failing simulated run, to show the cause of the failure.
namespace tumble::scenarios {

/// ShrinkTrial is one trial of the search: a simpler scenario, and the outcome of the method on this scenario.
struct ShrinkTrial {
  int run = 0;        ///< number of the trial; 1 is the original run
  std::string what;   ///< tried change: "4.5 s", "without world: rocks", "without 12 of 26"
  bool kept = false;  ///< the run still fails; the search continues from it
  Outcome outcome;    ///< `rejected` if the scenario could not be simulated
};

struct ShrinkOptions {
  Failure failure;
  /// The control is a method of the same kind, which must succeed on every accepted run. The control excludes scenarios
  /// that no method can solve. Null disables the control. If the control fails on the original run, the search ignores
  /// it.
  MethodPointer control;
  int budget = 60;           ///< number of simulated runs, at least 1
  double timeout_s = 300.0;  ///< time limit of one method run
  std::function<void(const ShrinkTrial&)> on_trial;
};

/// Fate is what the search did with a complication (removable detail) or with the duration.
enum class Fate { removed, smaller, needed, not_tried };
const char* to_string(Fate fate);

struct ShrinkLine {
  std::string what;  ///< "duration_s", or the complication's name
  Fate fate = Fate::not_tried;
  std::optional<double> from, to;       ///< original and final value of a duration, size or count
  std::optional<Outcome> without = {};  ///< for a needed complication: outcome without it (no failure)
};

struct Shrunk {
  Scenario scenario;    ///< scenario with constant parameters (fixed_scenario.hpp) and the original seed
  std::string failure;  ///< description of the failure: SameFailure::describe
  Outcome drawn, left;  ///< outcome of the original run and of `scenario`
  std::vector<ShrinkLine> lines;
  int runs = 0;
  bool complete = false;    ///< the budget was sufficient, and no single complication can be removed
  bool controlled = false;  ///< the control succeeded on all accepted runs
  /// Input (sweep/triage.hpp) whose true value prevents the failure of the original run and of every accepted run;
  /// empty if no input does so.
  std::string cure;
};

/// Simplifies a simulated run on which `method` fails, as long as the method still fails.
///
/// 1. Reduce the duration, which makes further trials cheap.
/// 2. Remove complications (complication.hpp) by delta debugging (delta_debugging.hpp).
/// 3. Reduce the remaining sizes and counts, then the duration again.
///
/// The search accepts a simpler run if it fails like the original run (same_failure.hpp). If the true value of an input
/// prevents the original failure, it must also prevent the failure of the simpler run. Without this condition, the
/// search could end at another cause. All trials use the random seed of the original run, so the search is
/// deterministic. The search misses a simpler run that can only be reached through a passing run.
///
/// Throws BadInput if the original run does not fail, or if `method` or the control cannot process the run. Throws the
/// exceptions of simulate_draw if the original run cannot be simulated.
Shrunk shrink(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
              const ShrinkOptions& options);

}  // namespace tumble::scenarios
