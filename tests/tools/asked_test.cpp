// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/asked.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/small_catalogue.hpp"
#include "tests/testing.hpp"
#include "tools/tumble/sweeping.hpp"

namespace tumble::tools {
namespace {

using scenarios::BadInput;

constexpr const char* kAsked = "position/rolling:position/autogain_fusion:position_end_error_share";

scenarios::Suite small_suite() {
  scenarios::Suite suite;
  suite.name = "small";
  suite.scenarios = {"roll"};
  suite.first_seed = 1;
  suite.last_seed = 14;
  suite.methods = {"position/rolling", "position/autogain_fusion"};
  suite.timeout_s = 60;
  return suite;
}

TEST(ParseQuestion, ReadsMethodsMetricAndMargin) {
  const scenarios::Question plain = parse_question(kAsked, 0.05, small_suite());
  EXPECT_EQ(plain.method, "position/rolling");
  EXPECT_EQ(plain.against, "position/autogain_fusion");
  EXPECT_EQ(plain.metric, "position_end_error_share");
  EXPECT_EQ(plain.margin.value, 0.0);
  EXPECT_EQ(plain.first_seed, 1u);
  const scenarios::Question share = parse_question(std::string(kAsked) + ":10%", 0.01, small_suite());
  EXPECT_TRUE(share.margin.relative);
  EXPECT_DOUBLE_EQ(share.margin.value, 0.1);
  EXPECT_EQ(share.risk, 0.01);
  EXPECT_NE(share.describe(), plain.describe());
}

TEST(ParseQuestion, RefusesWhatIsNone) {
  const auto refused = [](const std::string& text, const std::string& what) {
    try {
      parse_question(text, 0.05, small_suite());
      ADD_FAILURE() << text;
    } catch (const BadInput& error) {
      EXPECT_THAT(error.what(), HasSubstr(what)) << text;
    }
  };
  for (const char* text : {"", ":", "a:b", "a:b:", "a:b:c:d:e", "a::c", "position/rolling:position/oracle:"})
    refused(text, "write A:B:METRIC");
  refused("position/roling:position/rolling:position_end_error_share", "did you mean 'position/rolling'");
  refused("position/oracle:position/rolling:position_end_error_share", "method of the suite");
  refused("position/rolling:position/rolling:position_end_error_share", "is compared with itself");
  refused("position/rolling:position/autogain_fusion:position_end_error", "is unknown");
  refused(std::string(kAsked) + ":-1", "write a number of at least 0");
  refused(std::string(kAsked) + ":nan", "write a number of at least 0");
  refused(std::string(kAsked) + ":ten", "write a number of at least 0");
}

class SweepUntilTest : public scenarios::testing::SmallCatalogue {
 protected:
  void SetUp() override {
    SmallCatalogue::SetUp();
    session_.quiet = true;
  }

  AskedSweep run(const std::string& name, const std::string& asked, int jobs, const std::atomic<bool>* stop = nullptr) {
    const scenarios::Suite suite = small_suite();
    scenarios::SweepOptions options;
    options.jobs = jobs;
    options.stop = stop;
    return sweep_until(session_, {folder_}, suite, scenarios::DatabaseOwner(folder_ / name), options,
                       parse_question(asked, 0.05, suite));
  }

  /// Returns every row without its costs, in the order of seeds and methods.
  std::vector<std::string> rows(const std::string& name) const {
    std::vector<std::string> out;
    for (const scenarios::Outcome& row :
         scenarios::Results(folder_ / name, scenarios::Results::Mode::read_only).outcomes())
      out.push_back(std::to_string(100 + row.seed) + row.method + to_string(row.status) + row.estimate_digest);
    std::sort(out.begin(), out.end());
    return out;
  }

  Session session_;
};

// the sweep ends early, at the same draw for any number of jobs and after an interruption
TEST_F(SweepUntilTest, EndsWhenItIsAnswered) {
  const AskedSweep one = run("one.db", kAsked, 1);
  ASSERT_EQ(one.answers.size(), 1u);
  EXPECT_EQ(one.answers[0].finding, scenarios::Finding::better);
  EXPECT_EQ(one.answers[0].seeds, 8u) << "eight of eight: 9 / 2^8 < 0.05";
  EXPECT_EQ(one.progress.draws_done, 10u) << "the first step";
  EXPECT_EQ(one.progress.draws_total, 10u);
  const auto seen = rows("one.db");
  EXPECT_EQ(seen.size(), 20u);

  EXPECT_EQ(run("two.db", kAsked, 2).progress.draws_done, 10u);
  EXPECT_EQ(rows("two.db"), seen);

  std::atomic<bool> stop = true;
  EXPECT_LT(run("three.db", kAsked, 2, &stop).progress.draws_done, 10u);
  EXPECT_EQ(run("three.db", kAsked, 2).answers[0].seeds, 8u);
  EXPECT_EQ(rows("three.db"), seen);
}

// Control: a margin that no method reaches is answered with no; a question that stays open uses all seeds
TEST_F(SweepUntilTest, GoesOnWhileItIsOpen) {
  const AskedSweep asked = run("a.db", std::string(kAsked) + ":1e9", 2);
  EXPECT_EQ(asked.answers[0].finding, scenarios::Finding::worse);
  scenarios::Suite suite = small_suite();
  suite.last_seed = 4;
  scenarios::SweepOptions options;
  const AskedSweep open = sweep_until(session_, {folder_}, suite, scenarios::DatabaseOwner(folder_ / "b.db"), options,
                                      parse_question(kAsked, 0.05, suite));
  EXPECT_EQ(open.answers[0].finding, scenarios::Finding::undecided) << "four signs never answer";
  EXPECT_EQ(open.progress.draws_done, 4u);
  EXPECT_EQ(run("b.db", kAsked, 2).answers[0].finding, scenarios::Finding::better) << "more seeds continue the sweep";
}

}  // namespace
}  // namespace tumble::tools
