// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/triage.hpp"

/// A failing draw made shorter and simpler, so that one sees what it takes to fail.
namespace tumble::scenarios {

/// One run of the search: a simpler draw, simulated and estimated.
struct ShrinkTrial {
  int run = 0;        ///< from 1, the draw as it was
  std::string what;   ///< "4.5 s", "without world: rocks", "without 12 of 26"
  bool kept = false;  ///< it still fails, and is what is shrunk from here on
  Outcome outcome;    ///< `rejected` where it could not be simulated
};

struct ShrinkOptions {
  Failure failure;
  /// A method of the same kind that must not fail where the one in question does: what even it cannot do is no case.
  /// Null: none. Where it fails on the draw as it was, it is not asked again.
  MethodPointer control;
  int budget = 60;           ///< runs, at least 1: draws simulated, whatever is run on each
  double timeout_s = 300.0;  ///< for one run of a method
  std::function<void(const ShrinkTrial&)> on_trial;
};

/// What became of a thing that the draw could have done without.
enum class Fate { removed, smaller, needed, not_tried };
const char* to_string(Fate fate);

struct ShrinkLine {
  std::string what;  ///< "duration_s", or a complication's name
  Fate fate = Fate::not_tried;
  std::optional<double> from, to;       ///< of a length, a size or a count
  std::optional<Outcome> without = {};  ///< of a needed one: the run that did not fail for want of it
};

struct Shrunk {
  Scenario scenario;    ///< every number fixed (fixed_scenario.hpp), of the seed that it was drawn with
  std::string failure;  ///< how it fails: SameFailure::describe
  Outcome drawn, left;  ///< of the draw as it was, and of `scenario`
  std::vector<ShrinkLine> lines;
  int runs = 0;
  bool complete = false;    ///< the budget sufficed: nothing single can be taken away any more
  bool controlled = false;  ///< the control does not fail on any of the draws that were kept
};

/// Shrinks a draw on which `method` fails: a shorter run first, since all others cost less then; then as many
/// complications (complication.hpp) as go, by delta debugging (delta_debugging.hpp); then sizes and counts of those
/// that are needed; then the length once more. Each trial is simulated and estimated anew and counts when it fails as
/// the draw did (same_failure.hpp). Deterministic; what is random beyond the numbers stays what the seed makes it. Not
/// found: a simpler draw behind one that does not fail. Throws what simulate_draw throws of the draw as it is; BadInput
/// when it does not fail, or when method or control do not apply.
Shrunk shrink(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
              const ShrinkOptions& options);

}  // namespace tumble::scenarios
