// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

/// example_choice.hpp chooses, from the results alone, which simulated runs of a sweep become examples.
namespace tumble::scenarios {

/// ExampleCandidate is a scenario of the sweep, in the order of the suite.
struct ExampleCandidate {
  std::string scenario, robot;
};

struct ExampleDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const ExampleDraw&) const = default;
};

/// Finds the simulated run on which the baseline of the scenario has its median headline score. The headline score is
/// the first headline metric with a value, of the first kind of method other than attitude. Returns false if there is
/// no headline score.
bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed);

/// Returns at most `count` typical simulated runs, in the order of the candidates: first one scenario of each robot,
/// then a second scenario of each robot, and so on.
std::vector<ExampleDraw> choose_examples(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

/// FailedOn is a simulated run on which at least one method failed.
struct FailedOn {
  ExampleDraw draw;
  std::size_t methods = 0;  ///< number of failed methods without truth
};

/// Returns every simulated run with a failed method, sorted by number of failed methods (descending), scenario and
/// seed.
std::vector<FailedOn> rank_failures(const Summary& summary);

/// Returns the first `count` failed runs among the scenarios of the candidates, without runs on which only methods with
/// truth failed.
std::vector<ExampleDraw> choose_failures(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

/// Returns the scored outcomes of a simulated run, without binned metrics.
std::vector<Outcome> rows_to_show(const Results& results, const ExampleDraw& draw);

/// Returns a digest of the outcomes in an example and of their build. A stored example with another digest shows other
/// results.
std::string digest_of_rows(const Results& results, const ExampleDraw& draw);

}  // namespace tumble::scenarios
