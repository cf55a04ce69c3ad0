// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

/// Chooses the draws of a sweep to show as examples, from the results only.
namespace tumble::scenarios {

/// A scenario of the sweep, in the suite's order.
struct ExampleCandidate {
  std::string scenario, robot;
};

struct ExampleDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): Clang 14 takes the zero that a defaulted <=> compares with for a pointer
  auto operator<=>(const ExampleDraw&) const = default;
};

/// Finds the draw with the median headline score of the baseline in its scenario. Uses the first kind except attitude,
/// and its first headline metric with a value. Returns false if there is no such score.
bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed);

/// Returns at most `count` typical draws, in the order of the candidates: the first scenario of each robot, then each
/// second, and so on.
std::vector<ExampleDraw> choose_examples(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

/// A draw on which methods failed.
struct FailedOn {
  ExampleDraw draw;
  std::size_t methods = 0;  ///< failed methods that need no truth
};

/// Returns every draw with a failed method: most failures first, then by scenario and seed.
std::vector<FailedOn> rank_failures(const Summary& summary);

/// Returns the first `count` of these draws in the candidates' scenarios. Omits draws on which only oracles failed.
std::vector<ExampleDraw> choose_failures(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

/// Returns the scored rows of a draw, without points of curves.
std::vector<Outcome> rows_to_show(const Results& results, const ExampleDraw& draw);

/// Returns a digest of these rows and their build. An example with another digest belongs to other results.
std::string digest_of_rows(const Results& results, const ExampleDraw& draw);

}  // namespace tumble::scenarios
