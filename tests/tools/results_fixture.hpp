// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/sweep/results.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::tools::testing {

/// Returns the result of a method run on a simulated run of `hill`.
inline scenarios::Outcome hill_outcome(std::uint64_t seed, scenarios::Kind kind, const std::string& method,
                                       scenarios::OutcomeStatus status, std::vector<scenarios::Score> scores = {}) {
  scenarios::Outcome outcome;
  outcome.scenario = "hill";
  outcome.seed = seed;
  outcome.kind = kind;
  outcome.method = method;
  outcome.status = status;
  outcome.scores = std::move(scores);
  return outcome;
}

/// ResultsFixture is a test with a new results database.
class ResultsFixture : public test::TemporaryFolder {
 protected:
  void SetUp() override { results_.emplace(database(), scenarios::Results::Mode::create_or_append); }
  fs::path database() const { return folder_ / "a.db"; }
  scenarios::Results& results() { return *results_; }
  const scenarios::Results& results() const { return *results_; }

 private:
  std::optional<scenarios::Results> results_;
};

}  // namespace tumble::tools::testing
