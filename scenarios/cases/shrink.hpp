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
  FailureGoal failure;
  /// `control` is a reference method of the same kind as the tested method. The reference method must succeed on each
  /// simplified run, which excludes scenarios that no method can solve.
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
  std::optional<Outcome> without = {};  ///< outcome without this complication
};

struct Shrunk {
  Scenario scenario;    ///< constant parameters and original seed
  std::string failure;  ///< description of the failure: SameFailure::describe
  Outcome drawn, left;
  std::vector<ShrinkLine> lines;
  int runs = 0;
  bool complete = false;    ///< no single complication can be removed
  bool controlled = false;  ///< the control succeeded on all accepted runs
  /// Name of a wrong input that causes the failure, or empty. If the true value replaces the wrong input, the method
  /// succeeds.
  std::string cure;
};

/// Simplifies a simulated run by delta debugging and bisection, as long as `method` still fails in the same way as in
/// the original run (same_failure.hpp). If a wrong input (Shrunk::cure) causes the failure of the original run, the
/// same input must cause the failure of each simplified run.
Shrunk shrink(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
              const ShrinkOptions& options);

}  // namespace tumble::scenarios
