// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/temporary_folder.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::HasSubstr;
using Paths = std::vector<std::filesystem::path>;

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

class MergeTest : public testing::TemporaryFolder {
 protected:
  std::filesystem::path make(const std::string& name, const std::vector<Outcome>& rows,
                             const std::vector<RejectedDraw>& rejected = {}) {
    Results results(folder_ / name, Results::Mode::create_or_append);
    for (const Outcome& each : rows) results.store(each);
    for (const RejectedDraw& each : rejected) results.store(each);
    return folder_ / name;
  }
  std::string complaint(const Paths& in, bool mixed = false) {
    try {
      merge_results(out_, in, mixed);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  }
  std::vector<Outcome> merged() const { return Results(out_, Results::Mode::read_only).outcomes(); }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }
  void SetUp() override {
    TemporaryFolder::SetUp();
    out_ = folder_ / "out.db";
  }
  std::filesystem::path out_;
};

TEST_F(MergeTest, WhatWasScoredStaysInEitherOrder) {
  for (const OutcomeStatus worse : {OutcomeStatus::crashed, OutcomeStatus::timeout, OutcomeStatus::killed}) {
    for (const bool good_first : {true, false}) {
      std::filesystem::remove(out_);
      std::filesystem::remove(folder_ / "good.db");
      std::filesystem::remove(folder_ / "bad.db");
      const auto good = make("good.db", {row(1, OutcomeStatus::ok)});
      const auto bad = make("bad.db", {row(1, worse), row(2, OutcomeStatus::killed)});
      const MergeCounts counts = merge_results(out_, good_first ? Paths{good, bad} : Paths{bad, good}, false);
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
  EXPECT_EQ(merge_results(out_, Paths{a, b, a}, false).added, 3u);
  EXPECT_EQ(merged().size(), 3u);
  EXPECT_EQ(merge_results(out_, Paths{a, b}, false).added, 0u);
}

TEST_F(MergeTest, TwoAnswersOfOneBuildAreRefusedAndNothingIsLeft) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok, "one")});
  const auto b = make("b.db", {row(1, OutcomeStatus::ok, "two")});
  EXPECT_THAT(complaint({a, b}), HasSubstr("b.db: hill, seed 1, slam/icp: is ok with digest 'two', elsewhere ok"));
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_EQ(files(), 2u);
  const auto c = make("c.db", {row(1, OutcomeStatus::diverged, "one")});
  EXPECT_THAT(complaint({a, c}), HasSubstr("is diverged with digest"));
  // an output that was there before keeps what it had
  make("out.db", {row(9, OutcomeStatus::ok)});
  EXPECT_NE(complaint({a, b}), "");
  ASSERT_EQ(merged().size(), 1u);
  EXPECT_EQ(merged()[0].seed, 9u);
  // asked for, the first stays
  EXPECT_EQ(complaint({a, b}, true), "");
  EXPECT_EQ(merged()[0].estimate_digest, "one");
}

TEST_F(MergeTest, ARejectionGivesWayToAnOutcome) {
  const auto rejected = make("a.db", {}, {{"hill", 1, "no place", {}}, {"hill", 2, "no place", {}}});
  const auto run = make("b.db", {row(1, OutcomeStatus::ok)});
  for (const Paths& in : {Paths{rejected, run}, Paths{run, rejected}}) {
    std::filesystem::remove(out_);
    merge_results(out_, in, false);
    const Results results(out_, Results::Mode::read_only);
    EXPECT_EQ(results.outcomes().size(), 1u);
    ASSERT_EQ(results.rejected().size(), 1u);
    EXPECT_EQ(results.rejected()[0].seed, 2u);
  }
}

TEST_F(MergeTest, AnInputUnderAnotherNameIsNoOutput) {
  const auto a = make("a.db", {row(1, OutcomeStatus::ok)});
  std::filesystem::create_symlink("a.db", out_);
  EXPECT_THAT(complaint({a}), HasSubstr("both read and written"));
}

}  // namespace
}  // namespace tumble::scenarios
