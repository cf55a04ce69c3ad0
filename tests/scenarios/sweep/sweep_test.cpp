// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/sweep.hpp"
#include "scenarios/methods/registry.hpp"

#include <sys/resource.h>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/small_catalogue.hpp"
#include "tests/scenarios/testing.hpp"

// the test runs a whole sweep on the sphere, whose draws are short and have no map to score
namespace tumble::scenarios {
namespace {

Suite small_suite(std::uint64_t last_seed) {
  Suite suite;
  suite.name = "small";
  suite.scenarios = {"roll"};
  suite.first_seed = 1;
  suite.last_seed = last_seed;
  suite.methods = {"rate/raw", "rolling", "icp"};  // icp does not apply to the sphere
  suite.timeout_s = 60;
  return suite;
}

std::map<std::string, std::string> digests(const fs::path& database) {
  std::map<std::string, std::string> found;
  for (const Outcome& outcome : Results(database, Results::Mode::read_only).outcomes()) {
    found[std::to_string(outcome.seed) + to_string(outcome.kind)] = outcome.recording_digest + outcome.estimate_digest;
  }
  return found;
}

using SweepTest = testing::SmallCatalogue;
using testing::kRoll;

TEST_F(SweepTest, StoresEveryOutcomeResumesAndDoesNotDependOnJobs) {
  const auto path = folder_ / "a.db";
  // the sweep stops after the first draw
  std::atomic<bool> stop = false;
  SweepOptions options;
  options.stop = &stop;
  options.on_progress = [&](const SweepProgress& progress) { stop = progress.draws_done >= 1; };
  const SweepProgress stopped = sweep(data(), small_suite(2), DatabaseOwner(path), options);
  EXPECT_EQ(stopped.draws_done, 1u);
  EXPECT_EQ(stopped.draws_total, 2u);
  EXPECT_EQ(Results(path, Results::Mode::read_only).outcomes().size(), 2u);

  // a resumed sweep runs only the missing draws
  const SweepProgress resumed = sweep(data(), small_suite(2), DatabaseOwner(path), {});
  EXPECT_EQ(resumed.draws_done, 2u);
  EXPECT_EQ(resumed.outcomes, 2u);
  const Results results(path, Results::Mode::read_only);
  ASSERT_EQ(results.outcomes().size(), 4u);
  for (const Outcome& outcome : results.outcomes()) EXPECT_EQ(outcome.status, OutcomeStatus::ok) << outcome.message;
  EXPECT_EQ(results.note("suite"), "small");
  bool cost = false;
  for (const ScoreRow& row : results.scores()) cost = cost || row.metric == "estimate_peak_mib";
  EXPECT_TRUE(cost);

  // no work remains
  EXPECT_EQ(sweep(data(), small_suite(2), DatabaseOwner(path), {}).outcomes, 0u);

  // two processes and another file give the same bits, and the same as in this process
  SweepOptions two;
  two.jobs = 2;
  sweep(data(), small_suite(2), DatabaseOwner(folder_ / "b.db"), two);
  const auto a = digests(path);
  ASSERT_EQ(a.size(), 4u);
  EXPECT_EQ(a, digests(folder_ / "b.db"));
  const std::vector<MethodPointer> rolling = find_methods("rolling");
  const RunResult run = run_situation(data(), load_scenario(data(), "roll"), 2, rolling, 2);
  ASSERT_EQ(run.outcomes.size(), 1u);
  EXPECT_EQ(a.at("2position"), run.outcomes[0].recording_digest + run.outcomes[0].estimate_digest);
  EXPECT_EQ(run_digest(run).size(), 32u);
}

// no method reads a lidar here; motion and IMUs are the same, as the estimate's digest shows
TEST_F(SweepTest, RateMethodsAloneAreRunWithoutLidar) {
  write("scenarios/catalogue/roll.yaml",
        std::string(kRoll) + "  - {name: lidar, kind: rosette_lidar, device: mid100, site: mid100}\n");
  Suite suite = small_suite(1);
  suite.methods = {"rate/raw"};
  sweep(data(), suite, DatabaseOwner(folder_ / "rate.db"), {});
  sweep(data(), small_suite(1), DatabaseOwner(folder_ / "all.db"), {});
  const Scenario scenario = load_scenario(data(), "roll");
  const SimulatedDraw whole = simulate_draw(data(), scenario, 1, 1);
  ASSERT_EQ(whole.recording.sensors.lidars.size(), 1u);
  const std::string bare = digest_without_lidars(whole.recording);
  EXPECT_NE(bare, whole.recording_digest);
  EXPECT_EQ(simulate_draw(data(), scenario, 1, 1, Lidars::left_out).recording_digest, bare);
  const RunResult run = run_situation(data(), scenario, 1, find_methods("rate/raw"), 1);
  EXPECT_EQ(digests(folder_ / "rate.db").at("1rate"), bare + run.outcomes[0].estimate_digest);
  EXPECT_EQ(digests(folder_ / "all.db").at("1rate"), whole.recording_digest + run.outcomes[0].estimate_digest);
}

// when recordings are not kept, methods of this build that make no map run without lidar, with the same bits
TEST_F(SweepTest, UnseenRecordingsHaveTheLidarsThatAreRead) {
  write("scenarios/catalogue/roll.yaml",
        std::string(kRoll) + "  - {name: lidar, kind: rosette_lidar, device: mid100, site: mid100}\n");
  Suite suite = small_suite(1);
  suite.methods = {"rolling", "attitude/tumble", "position/tumble", "position/tumble_live"};
  SweepOptions unseen;
  unseen.recordings_unseen = true;
  sweep(data(), suite, DatabaseOwner(folder_ / "seen.db"), {});
  sweep(data(), suite, DatabaseOwner(folder_ / "unseen.db"), unseen);
  const SimulatedDraw whole = simulate_draw(data(), load_scenario(data(), "roll"), 1, 1);
  const std::string bare = digest_without_lidars(whole.recording);
  const Results as_seen(folder_ / "seen.db", Results::Mode::read_only);
  const Results results(folder_ / "unseen.db", Results::Mode::read_only);
  ASSERT_EQ(results.outcomes().size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const Outcome seen = as_seen.outcomes()[k], found = results.outcomes()[k];
    EXPECT_EQ(seen.recording_digest, whole.recording_digest);
    EXPECT_EQ(found.recording_digest, bare);
    EXPECT_EQ(found.method, seen.method);
    EXPECT_EQ(found.estimate_digest, seen.estimate_digest) << seen.method;
  }
  suite.methods.push_back("slam/poses_rolling");
  sweep(data(), suite, DatabaseOwner(folder_ / "maps.db"), unseen);
  for (const Outcome& outcome : Results(folder_ / "maps.db", Results::Mode::read_only).outcomes())
    EXPECT_EQ(outcome.recording_digest, whole.recording_digest) << "a map is made with a lidar";
}

// the simulation rejects a draw that never moves; the sweep stores it as rejected and does not try it again
TEST_F(SweepTest, ARejectedDrawIsKept) {
  std::string still = kRoll;
  still.replace(still.find("{uniform: [0.3, 0.5]}"), std::string("{uniform: [0.3, 0.5]}").size(), "0");
  write("scenarios/catalogue/roll.yaml", still);
  const auto path = folder_ / "a.db";
  EXPECT_EQ(sweep(data(), small_suite(1), DatabaseOwner(path), {}).rejected, 1u);
  const Results results(path, Results::Mode::read_only);
  ASSERT_EQ(results.rejected().size(), 1u);
  EXPECT_NE(results.rejected().front().message, "");
  EXPECT_EQ(results.outcomes().size(), 0u);
  const SweepProgress again = sweep(data(), small_suite(1), DatabaseOwner(path), {});
  EXPECT_EQ(again.rejected, 0u);
  EXPECT_EQ(again.draws_done, 1u);
}

TEST_F(SweepTest, WhatTheMachineKilledIsRunAgainOnDemandAlone) {
  const auto path = folder_ / "a.db";
  sweep(data(), small_suite(1), DatabaseOwner(path), {});
  const auto before = digests(path);
  {
    Results results(path, Results::Mode::create_or_append);
    for (Outcome outcome : results.outcomes()) {
      if (outcome.kind != Kind::rate) continue;
      outcome.status = OutcomeStatus::killed;
      outcome.estimate_digest.clear();
      results.store(outcome);
    }
  }
  EXPECT_NE(digests(path), before);
  EXPECT_EQ(sweep(data(), small_suite(1), DatabaseOwner(path), {}).outcomes, 0u);
  SweepOptions options;
  options.again = {OutcomeStatus::crashed};
  EXPECT_EQ(sweep(data(), small_suite(1), DatabaseOwner(path), options).outcomes, 0u);
  options.again = {OutcomeStatus::timeout, OutcomeStatus::killed};
  const SweepProgress again = sweep(data(), small_suite(1), DatabaseOwner(path), options);
  EXPECT_EQ(again.outcomes, 1u);
  EXPECT_EQ(again.not_ok(), 0u);
  // the recording of a rate method that runs alone has no lidar; this scenario has none anyway
  EXPECT_EQ(digests(path), before);
  options.again = {OutcomeStatus::ok};
  EXPECT_THROW(sweep(data(), small_suite(1), DatabaseOwner(path), options), BadInput);
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

TEST_F(SweepTest, TenMillionSeedsArePlannedOneAtATime) {
  std::atomic<bool> stop = false;
  SweepOptions options;
  options.stop = &stop;
  options.on_progress = [&](const SweepProgress& progress) { stop = progress.draws_done >= 1; };
  const double before_mib = peak_mib();
  const SweepProgress progress = sweep(data(), small_suite(10'000'000), DatabaseOwner(folder_ / "a.db"), options);
  EXPECT_EQ(progress.draws_total, 10'000'000u);
  EXPECT_EQ(progress.outcomes, 2u);
  EXPECT_LT(peak_mib() - before_mib, 50.0);  // a plan of all draws at once would need 4 GB
}

TEST_F(SweepTest, RefusesADatabaseOfOtherScenarios) {
  const auto path = folder_ / "a.db";
  Results(path, Results::Mode::create_or_append).set_note("data", "another catalogue");
  EXPECT_THAT(test::complaint([&] { sweep(data(), small_suite(1), DatabaseOwner(path), {}); }),
              HasSubstr("made from other models or scenarios"));
}

TEST_F(SweepTest, WrongUseIsBadInputBeforeAnythingRuns) {
  SweepOptions options;
  options.jobs = 0;
  EXPECT_THROW(sweep(data(), small_suite(1), DatabaseOwner(folder_ / "a.db"), options), BadInput);
  Suite suite = small_suite(1);
  suite.methods = {"no_such_method"};
  EXPECT_THROW(sweep(data(), suite, DatabaseOwner(folder_ / "a.db"), {}), BadInput);
  suite = small_suite(1);
  suite.scenarios = {"no_such_scenario"};
  EXPECT_THROW(sweep(data(), suite, DatabaseOwner(folder_ / "a.db"), {}), BadInput);
  suite = small_suite(1);
  suite.methods = {"icp"};  // only for the rig
  EXPECT_THROW(sweep(data(), suite, DatabaseOwner(folder_ / "a.db"), {}), BadInput);
  suite = small_suite(1);
  suite.last_seed = 0;
  EXPECT_THROW(sweep(data(), suite, DatabaseOwner(folder_ / "a.db"), {}), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
