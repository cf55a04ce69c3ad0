// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/failures.hpp"

#include "scenarios/sweep/run_again.hpp"
#include "tests/testing.hpp"
#include "tests/tools/results_fixture.hpp"

namespace tumble::tools {
namespace {

using scenarios::Kind;
using scenarios::OutcomeStatus;

class FailedDrawsTest : public testing::ResultsFixture {
 protected:
  void store(std::uint64_t seed, const std::string& method, OutcomeStatus status, const std::string& message = "") {
    scenarios::Outcome outcome = testing::hill_outcome(seed, Kind::rate, method, status);
    outcome.message = message;
    results().store(outcome);
  }
  FailedDraws found() const { return failed_draws(results(), scenarios::summarize(results()), database()); }
  /// Returns the commands of the first draw.
  std::vector<std::string> commands() const {
    const FailedDraws failed = found();
    std::vector<std::string> out;
    for (const FailedRun& run : failed.shown.at(0).runs) out.push_back(run.command);
    return out;
  }
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
  EXPECT_EQ(failed.shown[1].runs[0].command, "tumble run hill --seed 2 --method rate/raw");
}

TEST_F(FailedDrawsTest, AreMadeAgainByMethodsOutOfFilesAndOfRecordings) {
  store(1, "raw", OutcomeStatus::failed);
  store(1, "theirs", OutcomeStatus::failed);
  results().set_note(scenarios::method_note(Kind::rate, "theirs"), "1.0");
  results().set_note(scenarios::description_note("rate", "theirs"), "their folder/theirs.yaml");
  EXPECT_THAT(commands(), UnorderedElementsAre("tumble run hill --seed 1 --method rate/raw",
                                               "tumble run hill --seed 1 --method 'their folder/theirs.yaml'"));
  results().set_note("source", scenarios::kRecordingsSource);
  results().set_note(scenarios::recording_note("hill"), "drives/hill.h5");
  EXPECT_THAT(commands(),
              UnorderedElementsAre("tumble estimate drives/hill.h5 --method rate/raw -o hill",
                                   "tumble estimate drives/hill.h5 --method 'their folder/theirs.yaml' -o hill"));
}

TEST_F(FailedDrawsTest, OfMethodsThatNeedTheTruthComeLast) {
  store(1, "oracle", OutcomeStatus::failed);
  store(1, "oracle_clipped", OutcomeStatus::failed);
  store(2, "raw", OutcomeStatus::failed);
  scenarios::Summary summary = scenarios::summarize(results());
  for (scenarios::MethodSummary& method : summary.sections.at(0).methods)
    method.needs_truth = method.method.starts_with("oracle");
  const FailedDraws failed = failed_draws(results(), summary, folder_ / "a.db");
  ASSERT_EQ(failed.shown.size(), 2u) << "listed all the same";
  EXPECT_EQ(failed.shown[0].seed, 2u);
  EXPECT_EQ(failed.shown[1].runs.size(), 2u);
}

TEST_F(FailedDrawsTest, ThatAreKeptHaveACommandThatShowsThem) {
  store(1, "raw", OutcomeStatus::failed);
  store(2, "raw", OutcomeStatus::failed);
  const auto kept = folder_ / "a.db.files" / "kept" / "hill" / "2";
  fs::create_directories(kept / "estimates");
  std::ofstream(kept / "recording.h5") << "a recording";
  const FailedDraws failed = found();
  ASSERT_EQ(failed.shown.size(), 2u);
  EXPECT_EQ(failed.shown[0].replay_command, "");
  EXPECT_EQ(failed.shown[1].replay_command, "tumble replay " + scenarios::shell_word((kept / "recording.h5").string()) +
                                                " " + scenarios::shell_word((kept / "estimates").string()) +
                                                "/* -o hill-2.html");
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
