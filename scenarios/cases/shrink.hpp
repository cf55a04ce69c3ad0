// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/triage.hpp"

/// The function `shrink` makes a failing simulated run shorter and simpler, to show the cause of the failure.
namespace tumble::scenarios {

/// ShrinkTrial is one trial of the search: a simpler scenario that was simulated and estimated.
struct ShrinkTrial {
  int run = 0;        ///< from 1, the original run
  std::string what;   ///< "4.5 s", "without world: rocks", "without 12 of 26"
  bool kept = false;  ///< the run still fails, and the search continues from it
  Outcome outcome;    ///< `rejected` if simulation was impossible
};

struct ShrinkOptions {
  Failure failure;
  /// The control is a method of the same kind, which must succeed on each run on which the tested method fails; null
  /// disables the control. The control excludes scenarios that no method can solve. The search ignores the control if
  /// it fails on the original run.
  MethodPointer control;
  int budget = 60;           ///< number of simulated runs, at least 1
  double timeout_s = 300.0;  ///< limit of one method run
  std::function<void(const ShrinkTrial&)> on_trial;
};

/// Fate is the result of the search for one complication.
enum class Fate { removed, smaller, needed, not_tried };
const char* to_string(Fate fate);

struct ShrinkLine {
  std::string what;  ///< "duration_s", or a complication's name
  Fate fate = Fate::not_tried;
  std::optional<double> from, to;       ///< of a length, size or count
  std::optional<Outcome> without = {};  ///< for a needed item: the run without it, which did not fail
};

struct Shrunk {
  Scenario scenario;    ///< all numbers fixed (fixed_scenario.hpp), with the original seed
  std::string failure;  ///< how it fails: SameFailure::describe
  Outcome drawn, left;  ///< outcomes of the original draw and of `scenario`
  std::vector<ShrinkLine> lines;
  int runs = 0;
  bool complete = false;    ///< the budget was sufficient: no single item can be removed
  bool controlled = false;  ///< the control failed on no accepted run
  /// The true value of the input `cure` (sweep/triage.hpp) prevents the failure of the original run and of every
  /// accepted run; empty if there is no such input.
  std::string cure;
};

/// Simplifies a simulated run on which `method` fails, as long as the method still fails. The search first reduces the
/// duration, which makes further trials cheap. The search then removes complications (complication.hpp) by delta
/// debugging (delta_debugging.hpp), reduces the remaining sizes and counts, and reduces the duration again. The search
/// accepts a simpler run if it fails like the original run (same_failure.hpp). The true input that prevents the
/// original failure must also prevent the failure of the simpler run; otherwise the search could end at another cause.
/// The search is deterministic. All trials use the random seed of the original run. The search misses simpler runs if
/// the way to them leads through a run that passes.
///
/// Throws the exceptions of simulate_draw if the original run cannot be simulated. Throws BadInput if the original run
/// does not fail, or if method or control do not apply.
Shrunk shrink(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
              const ShrinkOptions& options);

}  // namespace tumble::scenarios
