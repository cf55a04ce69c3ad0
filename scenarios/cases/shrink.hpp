// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/triage.hpp"

namespace tumble::scenarios {

struct ShrinkTrial {
  int run = 0;        ///< number of the trial; 1 is the original run
  std::string what;   ///< tried change: "4.5 s", "without world: rocks", "without 12 of 26"
  bool kept = false;  ///< the run still fails; the search continues from it
  Outcome outcome;    ///< `rejected` if the scenario could not be simulated
};

struct ShrinkOptions {
  Failure failure;
  /// The control is a method of the same kind, which must succeed on every simulated run that the search accepts; the
  /// control excludes scenarios that no method can solve.
  MethodPointer control;
  int budget = 60;           ///< number of simulated runs, at least 1
  double timeout_s = 300.0;  ///< time limit of one method run
  std::function<void(const ShrinkTrial&)> on_trial;
};

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
  Outcome drawn, left;
  std::vector<ShrinkLine> lines;
  int runs = 0;
  bool complete = false;    ///< the budget was sufficient, and no single complication can be removed
  bool controlled = false;  ///< the control succeeded on all accepted runs
  /// Input whose true value prevents the failure of the original run and of every accepted run; empty if no input does
  /// so.
  std::string cure;
};

/// Simplifies a simulated run, by delta debugging and bisection, as long as `method` still fails in the same way
/// (same_failure.hpp). If the true value of an input prevents the original failure, it must also prevent the failure of
/// the simpler run; otherwise, the search could end at another cause. All trials use the random seed of the original
/// run, so the search is deterministic.
///
/// Throws BadInput if the original run does not fail, or if `method` or the control cannot process the run.
Shrunk shrink(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
              const ShrinkOptions& options);

}  // namespace tumble::scenarios
