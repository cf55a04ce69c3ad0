// SPDX-License-Identifier: BSD-3-Clause
// The test checks sweeps that are stopped and resumed, shards and their merge, and draws that are kept.
#include <signal.h>

#include "system/program.hpp"
#include "system/short_sweep.hpp"

namespace tumble::system_test {
namespace {

using ::testing::AnyOf;

/// Returns the scores of a report without costs.
json comparable(json report) {
  for (json& row : report["scores"]) {
    for (const char* cost : {"estimate_cpu_s", "simulate_cpu_s", "estimate_peak_mib"}) row["metrics"].erase(cost);
  }
  return report;
}

/// Waits for outcomes of a second draw, which show that the first draw is complete and stored.
void wait_for_a_draw(Running& running, const fs::path& database) {
  for (int i = 0; i < 1200 && !running.has_ended(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!fs::exists(database)) continue;
    const Ended report = run_shortened({"report", database.string(), "--json"});
    if (report.status == 0 && json_of(report)["draws"]["roll"] >= 2) break;
  }
}

TEST(Sweep, InterruptedKeepsWhatIsDoneAndGoesOn) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "stopped.db";
  // the sweep has far more draws than end before the signal
  std::vector<std::string> arguments = sweep_arguments(database, "1..500");
  arguments.insert(arguments.end(), {"--jobs", "1"});
  Running running(arguments, in_short_catalogue());
  // the sweep runs one draw at a time; a finished draw triggers the signal, however fast the machine is
  wait_for_a_draw(running, database);
  ASSERT_FALSE(running.has_ended()) << running.wait().err;
  running.signal(SIGINT);
  const Ended stopped = running.wait();
  EXPECT_EQ(stopped.status, 1) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("stopped: "));
  EXPECT_THAT(stopped.err, HasSubstr(" of 500 simulated runs are stored; run again to continue"));

  const std::int64_t kept = report_json(database)["draws"]["roll"];
  ASSERT_GE(kept, 1);
  ASSERT_LT(kept, 500);

  // a sweep over the finished seeds is no work, and changes nothing
  const std::int64_t done = json_of(stopped)["draws_done"];
  ASSERT_GE(done, 1);
  const Ended resumed = run_shortened(sweep_arguments(database, "1.." + std::to_string(done + 1)));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(json_of(resumed)["draws_done"], done + 1);
  EXPECT_LE(json_of(resumed)["outcomes"], 4) << "what was stored is not run again";

  // one sweep over the same seeds gives the same scores
  const fs::path whole = folder / "whole.db";
  ASSERT_EQ(run_shortened(sweep_arguments(whole, "1.." + std::to_string(done + 1))).status, 0);
  EXPECT_EQ(comparable(report_json(database)), comparable(report_json(whole)));
}

// the shell and the system both signal when a terminal closes; nohup leaves the signal ignored
TEST(Sweep, ASignalStopsItAndTheLockIsLetGo) {
  const fs::path database = test_folder() / "s.db", lock = database.string() + ".lock";
  std::vector<std::string> arguments = sweep_arguments(database, "1..500");
  arguments.insert(arguments.end(), {"--jobs", "1"});
  Running running(arguments, in_short_catalogue());
  wait_for_a_draw(running, database);
  ASSERT_FALSE(running.has_ended()) << running.wait().err;
  EXPECT_TRUE(fs::exists(lock));
  for (int signals = 0; signals < 2; ++signals) running.signal(SIGHUP);
  const Ended stopped = running.wait();
  EXPECT_EQ(stopped.status, 1) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr(" of 500 simulated runs are stored; run again to continue"));
  EXPECT_GE(report_json(database)["draws"]["roll"], 1);
  EXPECT_FALSE(fs::exists(lock));
}

TEST(Sweep, ThatEndsAtOnceLetsTheLockGoToo) {
  const fs::path database = test_folder() / "s.db", lock = database.string() + ".lock";
  const auto prepare = in_short_catalogue();
  std::vector<std::string> arguments = sweep_arguments(database, "1..500");
  arguments.insert(arguments.end(), {"--jobs", "1"});
  Running running(arguments, prepare);
  while (!fs::exists(lock) && !running.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  // the sweep obeys the first signal at the end of a draw, and the second at once; on a fast machine the first may end
  // the sweep
  for (int signals = 0; !running.has_ended() && signals < 100; ++signals) {
    running.signal(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_THAT(running.wait().status, AnyOf(128 + SIGTERM, 1));
  EXPECT_FALSE(fs::exists(lock));
}

TEST(Sweep, GoesOnUnderNohup) {
  const fs::path database = test_folder() / "s.db";
  const auto prepare = in_short_catalogue();
  Running running(sweep_arguments(database, "1..2"), [&] {
    prepare();
    signal(SIGHUP, SIG_IGN);
  });
  while (!fs::exists(database.string() + ".lock") && !running.has_ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  running.signal(SIGHUP);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(json_of(ended)["draws_done"], 2);
}

TEST(Sweep, ShardsMergeToTheWhole) {
  const fs::path folder = test_folder();
  std::vector<std::string> merge = {"merge", (folder / "merged.db").string()};
  for (const char* shard : {"1/2", "2/2"}) {
    const fs::path database = folder / (std::string(1, shard[0]) + ".db");
    std::vector<std::string> arguments = sweep_arguments(database, "1..3");
    arguments.insert(arguments.end(), {"--shard", shard});
    ASSERT_EQ(run_shortened(arguments).status, 0);
    merge.push_back(database.string());
  }
  const Ended merged = run_shortened(merge);
  ASSERT_EQ(merged.status, 0) << merged.err;
  ASSERT_EQ(run_shortened(sweep_arguments(folder / "whole.db", "1..3")).status, 0);
  const json report = comparable(report_json(folder / "merged.db"));
  EXPECT_EQ(report["draws"]["roll"], 3);
  EXPECT_EQ(report, comparable(report_json(folder / "whole.db")));
}

// a shard without a draw does not prevent the merge from keeping the draws of the others
TEST(Sweep, AShardWithoutSeedsKeepsByTheRuleOfTheOthers) {
  const fs::path folder = test_folder();
  std::vector<std::string> merge = {"merge", "--json", (folder / "merged.db").string()};
  for (const char* shard : {"1/2", "2/2"}) {
    merge.push_back((folder / (std::string(1, shard[0]) + ".db")).string());
    std::vector<std::string> arguments = sweep_arguments(merge.back(), "1");
    arguments.insert(arguments.end(), {"--shard", shard, "--keep", "all"});
    ASSERT_EQ(run_shortened(arguments).status, 0);
  }
  const Ended merged = run_shortened(merge);
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(json_of(merged)["kept"], 1);
}

// 'slip' is a suite, and also a scenario of that suite
TEST(Sweep, OfASuiteSomeScenariosAlone) {
  const fs::path folder = test_folder(), database = folder / "a.db";
  const std::vector<std::string> words = {"sweep", "slip",   "--seeds",    "1", "--method", "rate/raw",
                                          "--db",  database, "--examples", "0", "--json"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = words;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shortened(arguments);
  };
  const Ended one = with({"--scenario", "roll"});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(json_of(one)["draws_total"], 1);
  EXPECT_THAT(one.err, Not(HasSubstr("use --scenario")));
  EXPECT_EQ(report_json(database)["draws"], (json{{"roll", 1}}));
  const Ended unknown = with({"--scenario", "slib"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("unknown scenario of suite 'slip' 'slib'"));
  const Ended all = with({"--shard", "2/2"});  // this shard is empty
  EXPECT_EQ(all.status, 0) << all.err;
  EXPECT_THAT(all.err, HasSubstr("use --scenario slip to run only the scenario"));
}

// a range of seeds is requested from a suite that has only some of them
TEST(Sweep, NamedDrawsAreNoSeedsInARow) {
  const fs::path folder = test_folder(), suite = folder / "named.yaml";
  std::ofstream(suite) << "name: named\ndoc: d\nmethods: [rate/raw, rate/saave]\ndraws: {mild: {roll: [3, 8]}}\n";
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& what) {
    const Ended ended = run_shortened(arguments);
    EXPECT_EQ(ended.status, 2) << what;
    EXPECT_THAT(ended.err, HasSubstr(what));
    EXPECT_THAT(ended.err, HasSubstr("lists the simulated runs"));
  };
  const std::string database = (folder / "x.db").string();
  refused({"sweep", suite.string(), "--db", database, "--until", "rate/raw:rate/saave:rate_error_clipped_median_rad_s"},
          "--until");
  refused({"triage", suite.string(), "--method", "rate/raw", "--seeds", "1..2"}, "--seeds");
  refused({"sweep", suite.string(), "--db", database, "--scenario", "roll"}, "--scenario");
  refused({"gate", suite.string(), "--against", (folder / "g.yaml").string(), "--accept"},
          "'tumble gate' needs a range of seeds");
}

TEST(Sweep, RefusesWhatItCannotKeepOrAsk) {
  const fs::path database = test_folder() / "x.db";
  const auto refused = [&](const std::vector<std::string>& more, const std::string& what,
                           const std::string& seeds = "1") {
    std::vector<std::string> arguments = sweep_arguments(database, seeds);
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = run_shortened(arguments);
    EXPECT_EQ(ended.status, 2) << what;
    EXPECT_THAT(ended.err, HasSubstr(what));
  };
  refused({"--keep", "worst:0"}, "worst:N with N from 1 to 1000");
  refused({"--memory", "1"}, "--memory");
  refused({"--memory", "nan"}, "--memory");
  refused({"--until", "rate/raw:rate/tumble"}, "write A:B:METRIC");
  refused({"--until", "rate/raw:rate/tumble:rate_error_clipped_median_rad_s"}, "method of the suite");
  refused({"--until", "rate/raw:rate/raw:rate_error_clipped_median_rad_s", "--shard", "1/2"},
          "a shard contains only a part of the simulated runs");
  // the sweep detects this error after opening the database: a database that the sweep made is removed
  refused({"--again", "ok"}, "runs with status 'ok' cannot be repeated");
  refused({}, "split the range of seeds into parts", "1..20000000");
  refused({"--shard", "1/2"}, "split the range of seeds into parts", "0..18446744073709551615");
  EXPECT_TRUE(fs::is_empty(database.parent_path())) << fs::directory_iterator(database.parent_path())->path();
}

// the lidar's library reported too little memory as a CPU that is too old
TEST(Sweep, ADrawWithoutMemoryIsKilledAndBlamesNothingElse) {
  std::vector<std::string> arguments = sweep_arguments(test_folder() / "m.db", "1..1");
  arguments.insert(arguments.end(), {"--memory", "110", "--method", "position/tumble"});
  const json swept = json_of(run_shortened(arguments));
  EXPECT_EQ(swept["failures"], (json{{"killed", swept["outcomes"]}})) << swept;
}

}  // namespace
}  // namespace tumble::system_test
