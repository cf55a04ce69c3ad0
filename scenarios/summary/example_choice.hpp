// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

/// Which draws of a sweep are shown to people: by what the results hold, not by name.
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

/// The draw whose headline score under the baseline is the median one of its scenario: neither the best nor the worst.
/// The first kind but attitude, which says least about the motion, and the first of its headline metrics that has a
/// value choose. Returns false when the results have no such score.
bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed);

/// At most `count` typical draws, in the order of the candidates: of each robot its first scenario, then of each its
/// second, and so on.
std::vector<ExampleDraw> choose_examples(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

/// A draw on which methods failed.
struct FailedOn {
  ExampleDraw draw;
  std::size_t methods = 0;  ///< of those that need no truth
};

/// Every draw on which a method failed: those on which most methods did first, of equals by scenario and seed.
std::vector<FailedOn> rank_failures(const Summary& summary);

/// Of the candidates' scenarios the first `count` of these draws, but those on which only methods failed that know the
/// truth.
std::vector<ExampleDraw> choose_failures(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

/// The scored rows of a draw that an example shows: those without a variation.
std::vector<Outcome> rows_to_show(const Results& results, const ExampleDraw& draw);

/// Digest of these rows and of the build that they are of: an example that was made of another digest is of other
/// results.
std::string digest_of_rows(const Results& results, const ExampleDraw& draw);

}  // namespace tumble::scenarios
