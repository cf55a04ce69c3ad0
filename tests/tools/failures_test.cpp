// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/failures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/sweep/sweep_notes.hpp"
#include "tests/scenarios/sweep/temporary_folder.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::OutcomeStatus;
using scenarios::Results;

class FailedDrawsTest : public scenarios::testing::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    results_.emplace(folder_ / "a.db", Results::Mode::create_or_append);
  }
  void store(std::uint64_t seed, const std::string& method, OutcomeStatus status, const std::string& message = "") {
    scenarios::Outcome outcome;
    outcome.scenario = "hill";
    outcome.seed = seed;
    outcome.kind = Kind::rate;
    outcome.method = method;
    outcome.status = status;
    outcome.message = message;
    results_->store(outcome);
  }
  FailedDraws found() const { return failed_draws(*results_, scenarios::summarize(*results_)); }
  Results& results() { return *results_; }

 private:
  std::optional<Results> results_;
};

TEST_F(FailedDrawsTest, StandInTheOrderOfHowManyMethodsFailed) {
  store(1, "raw", OutcomeStatus::ok);
  store(2, "raw", OutcomeStatus::diverged, "left the truth");
  store(2, "saave", OutcomeStatus::ok);
  store(3, "raw", OutcomeStatus::crashed);
  store(3, "saave", OutcomeStatus::timeout);
  const FailedDraws failed = found();
  EXPECT_EQ(failed.draws, 2u);
  ASSERT_EQ(failed.shown.size(), 2u);
  EXPECT_EQ(failed.shown[0].seed, 3u);
  EXPECT_EQ(failed.shown[0].runs.size(), 2u);
  EXPECT_EQ(failed.shown[1].seed, 2u);
  ASSERT_EQ(failed.shown[1].runs.size(), 1u) << "saave ended well";
  EXPECT_EQ(failed.shown[1].runs[0].method, "rate/raw");
  EXPECT_EQ(failed.shown[1].runs[0].status, "diverged");
  EXPECT_EQ(failed.shown[1].runs[0].message, "left the truth");
  EXPECT_EQ(failed.shown[1].command, "tumble run hill --seed 2 --method rate/raw -o failed-hill-2");
}

TEST_F(FailedDrawsTest, AreNotMadeAgainByMethodsOutOfFilesNorOfRecordings) {
  store(1, "raw", OutcomeStatus::failed);
  store(1, "theirs", OutcomeStatus::failed);
  results().set_note(scenarios::method_note(Kind::rate, "theirs"), "1.0");
  EXPECT_EQ(found().shown.at(0).command, "tumble run hill --seed 1 --method rate/raw -o failed-hill-1");
  results().set_note("source", scenarios::kRecordingsSource);
  EXPECT_EQ(found().shown.at(0).command, "");
}

TEST_F(FailedDrawsTest, AreBounded) {
  for (std::uint64_t seed = 1; seed <= kFailedDrawsShown + 5; ++seed) store(seed, "raw", OutcomeStatus::failed);
  EXPECT_EQ(found().draws, kFailedDrawsShown + 5);
  EXPECT_EQ(found().shown.size(), kFailedDrawsShown);
}

TEST_F(FailedDrawsTest, AreNoneWhereAllIsWell) {
  store(1, "raw", OutcomeStatus::ok);
  EXPECT_EQ(found().draws, 0u);
  EXPECT_TRUE(found().shown.empty());
}

}  // namespace
}  // namespace tumble::tools
