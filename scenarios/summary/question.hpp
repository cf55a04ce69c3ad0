// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/summary/comparison.hpp"
#include "scenarios/sweep/results.hpp"

/// A question that a sweep may stop at: is one method better than another, looked at while the draws come in
/// (docs/maths/statistics.md, "Stopping when the question is answered").
namespace tumble::scenarios {

/// The note of results that a question was asked of: `describe` of it.
inline constexpr const char* kQuestionNote = "until";

/// Is `method` better than `against` in `metric`, by more than the margin?
struct Question {
  std::string method, against;  ///< "rate/tumble"; of one kind
  std::string metric;
  Margin margin;       ///< 0: better at all
  double risk = 0.05;  ///< of any answer, over all scenarios and looks, where neither is better
  int looks = 20;      ///< after equal parts of the seeds
  std::uint64_t first_seed = 1, last_seed = 1;
  std::vector<std::string> scenarios;

  /// The seeds after which it is looked at, rising; the last one is the sweep's.
  std::vector<std::uint64_t> look_seeds() const;
  /// All of it as one line, the same for the same question.
  std::string describe() const;
};

/// What the looks have said of one scenario.
struct Answer {
  std::string scenario;
  Finding finding = Finding::undecided;  ///< better by more than the margin; with a margin `worse` is: not so
  std::uint64_t seeds = 0;               ///< that had been seen at the look that answered, or at the last one
  std::int64_t better = 0, worse = 0;    ///< pairs that say so, at that look; equal ones are neither
  std::int64_t needed = 0;               ///< as many better, or worse, ones were an answer then
};

/// Throws BadInput: methods that are the same, of two kinds, or not known by a full name, a metric without a better
/// side, a margin or a risk beyond its bounds, no look.
void require_sound(const Question& question);

/// Writes the question into the results that are to answer it. Throws BadInput when another one stands there, or when
/// draws do: a risk holds for what was asked before.
void claim(Results& results, const Question& question, const std::filesystem::path& database);

/// The answers of the looks until `last_seed`, of which all draws up to it have been run: a function of the results of
/// these looks' seeds alone. In the order of the question's scenarios. A failed run ranks as the worst.
std::vector<Answer> answers(const Results& results, const Question& question, std::uint64_t last_seed);

/// Of an answer in words: "not by the margin" where there is one, and the method is not better by more than it, be it
/// worse or not.
const char* finding_text(const Answer& answer, const Question& question);

bool all_answered(const std::vector<Answer>& answers);

}  // namespace tumble::scenarios
