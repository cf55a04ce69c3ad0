// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/keep.hpp"
#include "scenarios/methods/registry.hpp"

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/draw_files.hpp"
#include "scenarios/sweep/merge.hpp"
#include "scenarios/sweep/small_catalogue.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

TEST(Keep, IsReadAndWritten) {
  for (const char* text : {"none", "failed", "all", "worst:1", "worst:1000"})
    EXPECT_EQ(to_string(parse_keep(text)), text);
  for (const char* text :
       {"", "some", "worst", "worst:", "worst:0", "worst:1001", "worst:-1", "worst:2x", "worst: 2"}) {
    EXPECT_THAT(test::complaint([&] { parse_keep(text); }), HasSubstr("must be none, failed, all, or worst:N"));
  }
}

class KeepTest : public testing::SmallCatalogue {
 protected:
  Suite suite(std::uint64_t first, std::uint64_t last) const {
    Suite suite;
    suite.name = "small";
    suite.scenarios = {"roll"};
    suite.first_seed = first;
    suite.last_seed = last;
    suite.methods = {"rate/raw", "position/rolling"};
    suite.timeout_s = 60;
    return suite;
  }

  SweepProgress run(const std::string& name, std::uint64_t first, std::uint64_t last, const std::string& keep,
                    int jobs = 1) const {
    SweepOptions options;
    options.jobs = jobs;
    options.keep = parse_keep(keep);
    return sweep(data(), suite(first, last), DatabaseOwner(folder_ / name), options);
  }

  /// Returns every kept file with its bytes.
  std::map<std::string, std::string> kept(const std::string& name) const {
    std::map<std::string, std::string> out;
    const fs::path root = folder_ / (name + ".files") / "kept";
    if (!fs::exists(root)) return out;
    for (const auto& each : fs::recursive_directory_iterator(root)) {
      if (!each.is_regular_file()) continue;
      out[each.path().lexically_relative(root).string()] = test::read_file(each.path());
    }
    return out;
  }

  std::vector<std::uint64_t> seeds(const std::string& name) const {
    std::vector<std::uint64_t> out;
    for (const DrawName& draw : KeptDraws(folder_ / name).found()) out.push_back(draw.seed);
    return out;
  }
};

// the rows of two methods are made by hand: which draws are kept follows from them alone
TEST_F(KeepTest, WhichDrawsFollowsFromTheRows) {
  const auto path = folder_ / "rows.db";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  {
    Results results(path, Results::Mode::create_or_append);
    const auto add = [&](std::uint64_t seed, const char* method, std::optional<double> value) {
      Outcome row{"roll", seed, Kind::position, method, OutcomeStatus::failed, "", {}, "", ""};
      if (value) row.status = OutcomeStatus::ok;
      if (value && value == value) row.scores = {{headline_metrics(Kind::position).front(), *value}};
      results.store(row);
    };
    const std::optional<double> failed;
    for (const auto& [seed, value] : std::initializer_list<std::pair<std::uint64_t, std::optional<double>>>{
             {1, 0.1}, {2, 0.5}, {3, failed}, {4, 0.5}, {5, 0.2}, {6, nan}}) {
      add(seed, "rolling", value);
      add(seed, "oracle", 1.0 - value.value_or(0.0));  // an oracle, which does not affect the kept draws
    }
    add(7, "tumble", 0.3);
  }
  const Results results(path, Results::Mode::read_only);
  const auto seeds_of = [&](const char* keep) {
    std::vector<std::uint64_t> out;
    for (const DrawName& draw : draws_to_keep(results, parse_keep(keep))) out.push_back(draw.seed);
    return out;
  };
  EXPECT_THAT(seeds_of("none"), ElementsAre());
  EXPECT_THAT(seeds_of("failed"), ElementsAre(3));
  EXPECT_THAT(seeds_of("all"), ElementsAre(1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(seeds_of("worst:1"), ElementsAre(3, 7));
  EXPECT_THAT(seeds_of("worst:2"), ElementsAre(2, 3, 7)) << "of two equal ones the lower seed";
  EXPECT_THAT(seeds_of("worst:9"), ElementsAre(1, 2, 3, 4, 5, 7)) << "what has no value is not ranked";
}

TEST_F(KeepTest, AllAreReadableAndTheSameForAnyNumberOfJobs) {
  const SweepProgress progress = run("one.db", 1, 3, "all");
  EXPECT_EQ(progress.kept, 3u);
  EXPECT_EQ(progress.to_keep, 3u);
  EXPECT_EQ(progress.not_kept, "");
  const auto one = kept("one.db");
  EXPECT_THAT(seeds("one.db"), ElementsAre(1, 2, 3));
  EXPECT_EQ(one.at("roll/2/command"),
            "tumble run roll --seed 2 --method rate/raw --method position/rolling -o roll_2\n");

  const Results results(folder_ / "one.db", Results::Mode::read_only);
  const fs::path draw = KeptDraws(folder_ / "one.db").folder_of({"roll", 2});
  for (const Outcome& row : results.outcomes_of("roll", 2)) {
    EXPECT_EQ(read_info(draw / "recording.h5").digest, row.recording_digest);
    Kind kind = Kind::slam;
    std::string method;
    const Estimate estimate = read_estimate(estimate_folder(draw, row.kind, row.method), kind, method, Frame::body);
    EXPECT_EQ(kind, row.kind);
    EXPECT_EQ(method, row.method);
    EXPECT_TRUE(estimate.status.ok());
  }

  run("two.db", 1, 3, "all", 2);
  EXPECT_EQ(kept("two.db"), one);
}

// the kept draws are bounded in number, with the same bits however the sweep was divided
TEST_F(KeepTest, TheWorstAreTheSameResumedAndInShards) {
  run("whole.db", 1, 4, "worst:1");
  const auto whole = kept("whole.db");
  ASSERT_GE(whole.size(), 4u);
  EXPECT_LE(seeds("whole.db").size(), 2u) << "one for each method";

  run("parts.db", 1, 2, "worst:1");
  EXPECT_LE(seeds("parts.db").size(), 2u);
  run("parts.db", 1, 4, "worst:1");
  EXPECT_EQ(kept("parts.db"), whole);

  run("shard_1.db", 1, 2, "worst:1");
  run("shard_2.db", 3, 4, "worst:1", 2);
  const std::vector<fs::path> shards = {folder_ / "shard_1.db", folder_ / "shard_2.db"};
  merge_results(DatabaseOwner(folder_ / "merged.db"), shards, false);
  EXPECT_EQ(merge_kept(DatabaseOwner(folder_ / "merged.db"), shards), seeds("whole.db").size());
  EXPECT_EQ(kept("merged.db"), whole);
  EXPECT_FALSE(fs::exists(folder_ / "merged.db.files/kept/.unfinished"));
}

// the unfinished files of a killed process do not count as a draw, and missing draws are made again
TEST_F(KeepTest, WhatIsMissingIsMadeAgain) {
  run("a.db", 1, 2, "all");
  const auto before = kept("a.db");
  const KeptDraws draws(folder_ / "a.db");
  fs::remove_all(draws.folder_of({"roll", 1}) / "estimates" / "rate-raw");
  fs::remove_all(draws.folder_of({"roll", 2}));
  fs::create_directories(folder_ / "a.db.files/kept/.unfinished/roll-2");
  EXPECT_FALSE(draws.holds({"roll", 2}, {}));
  const SweepProgress progress = run("a.db", 1, 2, "all");
  EXPECT_EQ(progress.outcomes, 0u) << "the rows stand";
  EXPECT_EQ(progress.kept, 2u);
  EXPECT_EQ(kept("a.db"), before);
  EXPECT_FALSE(fs::exists(folder_ / "a.db.files/kept/.unfinished"));

  // another rule removes the draws that it does not select; no rule keeps them
  run("a.db", 1, 2, "none");
  EXPECT_EQ(kept("a.db"), before);
  EXPECT_EQ(run("a.db", 1, 2, "failed").to_keep, 0u);
  EXPECT_TRUE(kept("a.db").empty());
}

TEST_F(KeepTest, ADiskThatRefusesCostsTheResultsNothing) {
  write("a.db.files/kept", "a file where the folder would be");
  const SweepProgress progress = run("a.db", 1, 1, "all");
  EXPECT_EQ(progress.outcomes, 2u);
  EXPECT_EQ(progress.not_ok(), 0u);
  EXPECT_EQ(progress.kept, 0u);
  EXPECT_EQ(progress.to_keep, 1u);
  EXPECT_THAT(progress.not_kept, HasSubstr("kept"));
}

// a draw with one estimate that could not be written, for example because the disk is full, is not kept at all
TEST_F(KeepTest, ADrawIsKeptWholeOrNotAtAll) {
  const SimulatedDraw draw = simulate_draw(data(), load_scenario(data(), "roll"), 1, 1);
  Keeping keeping;
  keeping.when = Keeping::When::always;
  keeping.folder = folder_ / "kept" / "roll" / "1";
  const auto finished = [&](const std::string& missed) {
    DrawFiles files(keeping);
    fs::create_directories(files.estimate(find_methods("rate/raw").front()->info));
    if (!missed.empty()) files.miss(missed);
    files.finish(draw, false);
    return files.error_code();
  };
  EXPECT_EQ(finished("no space left on device"), "no space left on device");
  EXPECT_FALSE(fs::exists(keeping.folder));
  EXPECT_EQ(finished(""), "");
  EXPECT_TRUE(fs::exists(keeping.folder / "recording.h5"));
}

TEST_F(KeepTest, TwoRulesAreNotMerged) {
  run("a.db", 1, 1, "all");
  run("b.db", 2, 2, "failed");
  const std::vector<fs::path> in = {folder_ / "a.db", folder_ / "b.db"};
  merge_results(DatabaseOwner(folder_ / "out.db"), in, false);
  EXPECT_EQ(merge_kept(DatabaseOwner(folder_ / "out.db"), in), 0u);
  EXPECT_TRUE(kept("out.db").empty());
}

// other rules do not apply to draws that a database had kept before others are merged into it
TEST_F(KeepTest, AMergeIntoRowsOfAnotherRuleLeavesWhatIsKept) {
  run("all.db", 1, 2, "all");
  run("failed.db", 3, 3, "failed");
  run("none.db", 4, 4, "none");
  const auto before = kept("all.db");
  const auto merged = [&](const char* out, const char* in) {
    const DatabaseOwner owner(folder_ / out);
    const std::vector<fs::path> inputs = {folder_ / in};
    merge_results(owner, inputs, false);
    return merge_kept(owner, inputs);
  };
  EXPECT_EQ(merged("all.db", "failed.db"), 0u);
  EXPECT_EQ(kept("all.db"), before);
  EXPECT_EQ(merged("none.db", "all.db"), 0u);
  EXPECT_TRUE(kept("none.db").empty());
  run("more.db", 5, 5, "all");
  EXPECT_EQ(merged("more.db", "all.db"), 3u) << "of all.db those that stand; its other row has none";
}

TEST_F(KeepTest, OtherMethodsAddTheirEstimates) {
  SweepOptions options;
  options.keep = parse_keep("all");
  for (const char* method : {"rate/raw", "position/rolling"}) {
    Suite one = suite(1, 1);
    one.methods = {method};
    EXPECT_EQ(sweep(data(), one, DatabaseOwner(folder_ / "a.db"), options).kept, 1u);
  }
  const auto both = kept("a.db");
  EXPECT_TRUE(both.contains("roll/1/estimates/rate-raw/estimate.json"));
  EXPECT_TRUE(both.contains("roll/1/estimates/position-rolling/estimate.json"));
  EXPECT_EQ(run("a.db", 1, 1, "all").kept, 1u);
  EXPECT_EQ(kept("a.db").size(), both.size());
}

// a draw that is kept because a method died contains what that method would have read
TEST_F(KeepTest, ACrashCostsTheRecordingNoLidar) {
  std::string text = read_text_file(test::source_dir() / "scenarios/catalogue/hill.yaml");
  for (const auto& [from, to] : {std::pair{"name: hill", "name: ride"}, {"duration_s: 10", "duration_s: 3"}}) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, std::string(from).size(), to);
  }
  write("scenarios/catalogue/ride.yaml", text);
  Suite ride = suite(1, 1);
  ride.scenarios = {"ride"};
  ride.methods = {"rate/raw", "slam/tumble"};
  SweepOptions options;
  options.keep = parse_keep("worst:1");
  {
    Results results = open_results(data(), ride, folder_ / "a.db");
    Outcome row{"ride", 1, Kind::rate, "raw", OutcomeStatus::ok, "", {}, "", ""};
    row.scores = {{headline_metrics(Kind::rate).front(), 1.0}};
    results.store(row);
    results.store(Outcome{"ride", 1, Kind::slam, "tumble", OutcomeStatus::crashed, "", {}, "", ""});
  }
  const SweepProgress progress = sweep(data(), ride, DatabaseOwner(folder_ / "a.db"), options);
  EXPECT_EQ(progress.outcomes, 0u) << "the rows stand";
  ASSERT_EQ(progress.kept, 1u) << progress.not_kept;
  const fs::path draw = KeptDraws(folder_ / "a.db").folder_of({"ride", 1});
  EXPECT_EQ(read_sensors(draw / "recording.h5").lidars.size(), 1u);
}

}  // namespace
}  // namespace tumble::scenarios
