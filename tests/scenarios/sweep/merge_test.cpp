// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/merge.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <unistd.h>

#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_again.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using Paths = std::vector<fs::path>;

Outcome row(std::uint64_t seed, OutcomeStatus status, const std::string& digest = "e") {
  Outcome outcome;
  outcome.scenario = "hill";
  outcome.seed = seed;
  outcome.kind = Kind::slam;
  outcome.method = "icp";
  outcome.status = status;
  if (was_scored(status)) {
    outcome.scores = {{"ate_m", 0.5}};
    outcome.recording_digest = "r";
    outcome.estimate_digest = digest;
  }
  return outcome;
}

class MergeTest : public test::TemporaryFolder {
 protected:
  fs::path make(const std::string& name, const std::vector<Outcome>& rows,
                const std::vector<RejectedDraw>& rejected = {}) {
    Results results(folder_ / name, Results::Mode::create_or_append);
    for (const Outcome& each : rows) results.store(each);
    for (const RejectedDraw& each : rejected) results.store(each);
    return folder_ / name;
  }
  std::string complaint(const Paths& in, bool mixed = false) {
    return test::complaint([&] { merge_results(DatabaseOwner(out_), in, mixed); });
  }
  std::vector<Outcome> merged() const { return Results(out_, Results::Mode::read_only).outcomes(); }
  const fs::path out_ = folder_ / "out.db";
};

TEST_F(MergeTest, WhatWasScoredStaysInEitherOrder) {
  for (const OutcomeStatus worse : {OutcomeStatus::crashed, OutcomeStatus::timeout, OutcomeStatus::killed}) {
    for (const bool good_first : {true, false}) {
      fs::remove(out_);
      fs::remove(folder_ / "good.db");
      fs::remove(folder_ / "bad.db");
      const auto good = make("good.db", {row(1, OutcomeStatus::ok)});
      const auto bad = make("bad.db", {row(1, worse), row(2, OutcomeStatus::killed)});
      const MergeCounts counts =
          merge_results(DatabaseOwner(out_), good_first ? Paths{good, bad} : Paths{bad, good}, false);
      EXPECT_EQ(counts.added, 2u);
      EXPECT_EQ(counts.replaced, good_first ? 0u : 1u);
      EXPECT_EQ(counts.held, good_first ? 1u : 0u);
      ASSERT_EQ(merged().size(), 2u);
      EXPECT_EQ(merged()[0].status, OutcomeStatus::ok) << to_string(worse) << good_first;
      EXPECT_EQ(merged()[1].status, OutcomeStatus::killed);
      EXPECT_EQ(Results(out_, Results::Mode::read_only).scores().front().value, 0.5);
    }
  }
}

TEST_F(MergeTest, CountsWhatItWrote) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok), row(2, OutcomeStatus::diverged)});
  const auto b = make("b.db", {row(2, OutcomeStatus::diverged), row(3, OutcomeStatus::failed)});
  EXPECT_EQ(merge_results(DatabaseOwner(out_), Paths{a, b, a}, false).added, 3u);
  EXPECT_EQ(merged().size(), 3u);
  EXPECT_EQ(merge_results(DatabaseOwner(out_), Paths{a, b}, false).added, 0u);
}

TEST_F(MergeTest, SaysOfAllInputsHowTheyWereAskedFor) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok)});
  const auto b = make("b.db", {row(2, OutcomeStatus::ok)});
  const auto shard = make("c.db", {row(3, OutcomeStatus::ok)});
  Results(a, Results::Mode::create_or_append).set_note(kCommandNote, "hill --seeds 1..1");
  Results(b, Results::Mode::create_or_append).set_note(kCommandNote, "throw --seeds 2..3");
  Results(shard, Results::Mode::create_or_append).set_note(kCommandNote, "throw --seeds 2..3");
  merge_results(DatabaseOwner(out_), Paths{a, b, shard}, false);
  EXPECT_EQ(Results(out_, Results::Mode::read_only).note(kCommandNote), "hill --seeds 1..1\nthrow --seeds 2..3");
}

TEST_F(MergeTest, TwoAnswersOfOneBuildAreRefusedAndNothingIsLeft) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok, "one")});
  const auto b = make("b.db", {row(1, OutcomeStatus::ok, "two")});
  EXPECT_THAT(complaint({a, b}), HasSubstr("b.db: hill, seed 1, slam/icp: the result has status ok and digest 'two', "
                                           "but another database has status ok"));
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_EQ(files(), 2u);
  const auto c = make("c.db", {row(1, OutcomeStatus::diverged, "one")});
  EXPECT_THAT(complaint({a, c}), HasSubstr("has status diverged and digest"));
  // an existing output keeps its content
  make("out.db", {row(9, OutcomeStatus::ok)});
  EXPECT_NE(complaint({a, b}), "");
  ASSERT_EQ(merged().size(), 1u);
  EXPECT_EQ(merged()[0].seed, 9u);
  // on request, the first row is kept
  EXPECT_EQ(complaint({a, b}, true), "");
  EXPECT_EQ(merged()[0].estimate_digest, "one");
}

// the digest covers the estimate: its scores are compared too, except costs, which differ between any two runs
TEST_F(MergeTest, OneEstimateHasOneScore) {
  const auto scored = [](std::vector<Score> scores) {
    Outcome outcome = row(1, OutcomeStatus::ok);
    outcome.scores = std::move(scores);
    return outcome;
  };
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const auto a = make("a.db", {row(0, OutcomeStatus::ok), scored({{"ate_m", 0.5}, {"estimate_cpu_s", 1.0}})});
  const auto same = make("same.db", {scored({{"ate_m", 0.5}, {"estimate_cpu_s", 2.0}}), row(2, OutcomeStatus::ok)});
  EXPECT_EQ(complaint({a, same}), "");
  for (const auto& [values, says] :
       {std::pair{std::vector<Score>{{"ate_m", 0.25}}, "ate_m is 0.25, but 0.5 in another database"},
        {{{"ate_m", nan}}, "ate_m is nan, but 0.5 in another database"},
        {{{"ate_m", inf}}, "ate_m is inf, but 0.5 in another database"},
        {{}, "ate_m is none, but 0.5 in another database"},
        {{{"ate_m", 0.5}, {"rpe_1m_m", 1.0}}, "rpe_1m_m is 1, but none in another database"}}) {
    fs::remove(folder_ / "b.db");
    fs::remove(out_);
    const auto b = make("b.db", {scored(values), row(2, OutcomeStatus::ok)});
    EXPECT_THAT(complaint({a, b}), HasSubstr(std::string("b.db: hill, seed 1, slam/icp: ") + says));
    EXPECT_FALSE(fs::exists(out_));
    EXPECT_EQ(complaint({a, b}, true), "") << "asked for, the first stays";
    EXPECT_EQ(Results(out_, Results::Mode::read_only).scores().size(), 4u);
  }
  const auto unknown = make("unknown.db", {scored({{"ate_m", nan}})});
  fs::remove(out_);
  EXPECT_EQ(complaint({unknown, unknown}), "") << "what is unknown twice does not differ";
}

TEST_F(MergeTest, AScoreThatIsNoNumberIsNoZero) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok)});
  SQLite::Database(a.string(), SQLite::OPEN_READWRITE).exec("UPDATE score_values SET value = 'good'");
  EXPECT_THAT(complaint({a}), HasSubstr("a.db: hill, seed 1, slam/icp, ate_m: is text; it must be a number or null"));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(MergeTest, ARejectionGivesWayToAnOutcome) {
  const auto rejected = make("a.db", {}, {{"hill", 1, "no place", {}}, {"hill", 2, "no place", {}}});
  const auto run = make("b.db", {row(1, OutcomeStatus::ok)});
  for (const Paths& in : {Paths{rejected, run}, Paths{run, rejected}}) {
    fs::remove(out_);
    merge_results(DatabaseOwner(out_), in, false);
    const Results results(out_, Results::Mode::read_only);
    EXPECT_EQ(results.outcomes().size(), 1u);
    ASSERT_EQ(results.rejected().size(), 1u);
    EXPECT_EQ(results.rejected()[0].seed, 2u);
  }
}

// the result of a merge equals the one of storing every row in one database, whatever the order and the number of
// shards
TEST_F(MergeTest, HasAllThatTheShardsHave) {
  std::vector<Outcome> rows;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Outcome plain = row(seed, seed % 7 == 0 ? OutcomeStatus::crashed : OutcomeStatus::ok, "e" + std::to_string(seed));
    plain.scores.push_back({"nothing", std::nan("")});
    plain.scores.push_back({"far", std::numeric_limits<double>::infinity()});
    plain.message = "seed " + std::to_string(seed);
    Outcome varied = plain;
    varied.setting = {"world.slope_rad", 0.1 * static_cast<double>(seed % 3)};
    rows.push_back(plain);
    rows.push_back(varied);
    plain.kind = Kind::rate;
    plain.method = "raw";
    plain.scores.clear();
    rows.push_back(plain);
  }
  const auto fill = [&](const fs::path& path, std::size_t first, std::size_t step) {
    Results results(path, Results::Mode::create_or_append);
    for (std::size_t i = first; i < rows.size(); i += step) {
      results.store(rows[i]);
      results.store(DrawValues{rows[i].scenario, rows[i].seed, {{"motion_path_m", 2.0}}, rows[i].setting});
    }
    results.set_note(method_note(Kind::rate, "raw"), "version 1");
    return path;
  };
  fill(folder_ / "whole.db", 0, 1);
  Paths shards;
  for (std::size_t k = 0; k < 13; ++k) shards.push_back(fill(folder_ / ("s" + std::to_string(k) + ".db"), k, 13));
  const MergeCounts counts = merge_results(DatabaseOwner(out_), shards, false);
  EXPECT_EQ(counts.added, rows.size());
  EXPECT_EQ(counts.held + counts.replaced, 0u);
  const Results whole(folder_ / "whole.db", Results::Mode::read_only), joined(out_, Results::Mode::read_only);
  const auto text_of = [](const Results& results) {
    std::vector<std::string> lines;
    for (const ScoreRow& s : results.scores(Rows::all)) {
      lines.push_back(s.scenario + " " + std::to_string(s.seed) + " " + s.kind + "/" + s.method + " " +
                      to_string(s.status) + " " + s.metric + " " + std::to_string(s.value) + " " + s.setting.key +
                      std::to_string(s.setting.value));
    }
    for (const Outcome& o : results.outcomes(Rows::all))
      lines.push_back(o.message + o.recording_digest + o.estimate_digest);
    for (const DrawValues& d : results.draws(Rows::all)) lines.push_back(d.scenario + std::to_string(d.seed));
    return lines;
  };
  ASSERT_GT(text_of(whole).size(), 300u);
  EXPECT_EQ(text_of(joined), text_of(whole));
  EXPECT_EQ(joined.note(method_note(Kind::rate, "raw")), "version 1");
  EXPECT_EQ(joined.notes().at("build"), whole.note("build"));
}

// an existing row is removed with its scores, which SQLite does not do during a merge
TEST_F(MergeTest, ScoresInAnyNumberArriveAndBelongToTheirOutcomes) {
  const auto with_scores = [](Outcome outcome, int scores) {
    outcome.scores.clear();
    for (int i = 0; i < scores; ++i) outcome.scores.push_back({"m" + std::to_string(1000 + i), 0.25 * i});
    return outcome;
  };
  const std::vector<int> numbers = {0, 1, 63, 64, 65, 3, 128, 200};
  std::vector<Outcome> worse, better;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    worse.push_back(with_scores(row(i, OutcomeStatus::crashed), 7));
    better.push_back(with_scores(row(i, OutcomeStatus::ok), numbers[i]));
  }
  const auto bad = make("bad.db", worse), good = make("good.db", better);
  {
    Results results(good, Results::Mode::create_or_append);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      results.store(DrawValues{"hill", i, with_scores(row(i, OutcomeStatus::ok), numbers[i]).scores, {}});
  }
  const MergeCounts counts = merge_results(DatabaseOwner(out_), Paths{bad, good}, false);
  EXPECT_EQ(counts.added, numbers.size());
  EXPECT_EQ(counts.replaced, numbers.size());
  const auto everything = [](const fs::path& path) {
    std::vector<std::string> lines;
    const Results results(path, Results::Mode::read_only);
    for (const ScoreRow& s : results.scores(Rows::all))
      lines.push_back(std::to_string(s.seed) + " " + to_string(s.status) + " " + s.metric + std::to_string(s.value));
    for (const DrawValues& d : results.draws(Rows::all))
      for (const Score& s : d.values) lines.push_back(std::to_string(d.seed) + s.metric + std::to_string(s.value));
    return lines;
  };
  EXPECT_EQ(everything(out_), everything(good));
  SQLite::Database plain(out_.string());
  SQLite::Statement orphans(plain, "PRAGMA foreign_key_check");
  EXPECT_FALSE(orphans.executeStep());
  EXPECT_EQ(plain.execAndGet("PRAGMA integrity_check").getString(), "ok");
}

TEST_F(MergeTest, ARejectionOfTwoShardsIsOne) {
  const auto a = make("a.db", {}, {{"hill", 1, "no place", {}}}), b = make("b.db", {}, {{"hill", 1, "no place", {}}});
  const MergeCounts counts = merge_results(DatabaseOwner(out_), Paths{a, b}, false);
  EXPECT_EQ(counts.added, 1u);
  EXPECT_EQ(counts.rejected, 1u);
  EXPECT_EQ(counts.held, 1u);
}

TEST_F(MergeTest, ADamagedShardIsNamedAndNothingIsLeft) {
  std::vector<Outcome> rows;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) rows.push_back(row(seed, OutcomeStatus::ok));
  const auto a = make("a.db", rows);
  fs::resize_file(a, fs::file_size(a) / 2);
  EXPECT_THAT(complaint({a}), HasSubstr("a.db"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(MergeTest, WaitsForNobodyWhoWrites) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok)});
  const DatabaseOwner owner(out_);
  EXPECT_THAT(complaint({a}), HasSubstr("out.db: process " + std::to_string(getpid()) + " on "));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(MergeTest, AnInputUnderAnotherNameIsNoOutput) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok)});
  fs::create_symlink("a.db", out_);
  EXPECT_THAT(complaint({a}), HasSubstr("both input and output"));
}

}  // namespace
}  // namespace tumble::scenarios
