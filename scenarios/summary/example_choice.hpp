// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"

namespace tumble::scenarios {

struct ExampleCandidate {
  std::string scenario, robot;
};

struct ExampleDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): false positive of clang-tidy 14 for a defaulted operator<=>
  auto operator<=>(const ExampleDraw&) const = default;
};

bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed);

std::vector<ExampleDraw> choose_examples(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

struct FailedOn {
  ExampleDraw draw;
  std::size_t methods = 0;  ///< failed methods without truth
};

std::vector<FailedOn> rank_failures(const Summary& summary);

/// Chooses runs on which methods failed. A run is omitted if the only failed methods are methods that receive the
/// truth.
std::vector<ExampleDraw> choose_failures(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count);

std::vector<Outcome> rows_to_show(const Results& results, const ExampleDraw& draw);

std::string digest_of_rows(const Results& results, const ExampleDraw& draw);

}  // namespace tumble::scenarios
