// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/comparison.hpp"
#include "scenarios/sweep/results.hpp"

/// A sweep over many simulated runs can stop early if a confidence sequence already shows whether one method is better
/// than another method (docs/maths/statistics.md, "Confidence sequence").
namespace tumble::scenarios {

inline constexpr const char* kQuestionNote = "until";

struct Question {
  std::string method, against;  ///< "rate/tumble"; both methods are of one kind
  std::string metric;
  Margin margin;       ///< 0: any improvement
  double risk = 0.05;  ///< of any wrong answer
  std::uint64_t first_seed = 1;
  std::vector<std::string> scenarios;

  std::string describe() const;
};

struct Answer {
  std::string scenario;
  Finding finding = Finding::undecided;  ///< `worse`: not better by the margin
  std::uint64_t seeds = 0;               ///< up to the finding
  std::int64_t better = 0, worse = 0;    ///< without ties
  Interval better_share{};               ///< anytime-valid interval of the share of better runs
};

void require_sound(const Question& question);

/// Stores the question of a sweep (is one method better than another method?) in the results database before the first
/// run. Throws BadInput if the database contains a different question, or contains runs but no question.
void claim(Results& results, const Question& question, const std::filesystem::path& database);

/// Answers the question separately for each scenario. All simulated runs up to the seed `last_seed` must be complete,
/// and later runs have no effect.
std::vector<Answer> answers(const Results& results, const Question& question, std::uint64_t last_seed);

const char* finding_text(const Answer& answer, const Question& question);

bool all_answered(const std::vector<Answer>& answers);

}  // namespace tumble::scenarios
