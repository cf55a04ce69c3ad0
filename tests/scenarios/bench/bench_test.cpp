// SPDX-License-Identifier: BSD-3-Clause
// The test checks what a page of the benchmark says of results with known medians.
#include "scenarios/bench/bench.hpp"

#include "scenarios/bench/bench_result.hpp"
#include "tests/scenarios/bench/some_result.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using testing::kError;
using testing::some_result;

Suite small() {
  Suite suite;
  suite.name = "small";
  suite.timeout_s = 60;
  suite.classes = {{"mild", {{"hill", 1}}}, {"wild", {{"hill", 18446744073709551615u}, {"hill", 3}}}};
  return suite;
}

TEST(Bench, AFailureRanksAsTheWorst) {
  const std::vector<BenchResult> all = {some_result("mine", {0.1, 0.2, -1.0, 0.4})};
  const BenchCell wild = bench_cell(all[0], kError, "wild", all);
  EXPECT_EQ(wild.draws, 3u);
  EXPECT_EQ(wild.lost, 1u);
  EXPECT_EQ(wild.median, 0.4);
  EXPECT_EQ(bench_cell(all[0], kError, "mild", all).median, 0.1);
  EXPECT_EQ(bench_cell(all[0], kError, "", all).draws, 4u);
  const std::vector<BenchResult> lost = {some_result("mine", {-1.0, -1.0, 0.3})};
  EXPECT_TRUE(std::isinf(bench_cell(lost[0], kError, "", lost).median));
}

TEST(Bench, ADrawWithNothingToScoreDoesNotCountForAnybody) {
  const std::vector<BenchResult> all = {some_result("mine", {-1.0, 0.2, 0.3}), some_result("raw", {0.0, 0.5, 0.1}, 0)};
  EXPECT_EQ(bench_cell(all[0], kError, "mild", all).draws, 0u) << "it crashed where another had nothing to score";
  EXPECT_TRUE(std::isnan(bench_cell(all[1], kError, "mild", all).median));
  EXPECT_EQ(bench_cell(all[0], kError, "mild", {}).lost, 1u) << "alone nobody can know";
  const BenchWins wins = bench_wins(all[0], all[1], kError, all);
  EXPECT_EQ(wins.draws, 2u);
  EXPECT_EQ(wins.better, 1u);
}

TEST(Bench, ResultsOfAnotherSuiteAreRefused) {
  const auto refusal = [](const BenchResult& result, const Suite& suite) -> std::string {
    return test::complaint([&] { require_of_suite(result, suite); });
  };
  BenchResult result = some_result("mine", {0.1, 0.2, 0.3});
  result.suite_digest = bench_suite_digest(small());
  EXPECT_EQ(refusal(result, small()), "");
  Suite other = small();
  other.classes[1].draws[1].second = 4;
  EXPECT_THAT(refusal(result, other), HasSubstr("this comparison needs results of suite"));
  other = small();
  other.classes[0].name = "soft";
  EXPECT_THAT(refusal(result, other), HasSubstr("this comparison needs results of suite"));
  other = small();
  other.timeout_s = 61;
  EXPECT_THAT(refusal(result, other), HasSubstr("this comparison needs results of suite"));
  result.draws.pop_back();
  EXPECT_THAT(refusal(result, small()), HasSubstr("contains 2 simulated runs"));
}

TEST(Bench, ResultsOfAnotherSimulationAreReported) {
  const BenchResult a = some_result("a", {0.1, 0.2, 0.3});
  BenchResult b = some_result("b", {0.1, 0.2, 0.3});
  EXPECT_EQ(other_recording(a, b), "");
  b.draws[2].recording = "";  // a draw whose process crashed
  EXPECT_EQ(other_recording(a, b), "");
  b.draws[2].recording = "another";
  EXPECT_EQ(other_recording(a, b), "hill 3");
}

// The test checks that the published line is read back unchanged, and that any other line is rejected.
std::string refusal(const std::string& line) {
  return test::complaint([&] { parse_bench_result(line, "a.jsonl:3"); });
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), by);
}

TEST(BenchResult, ComesBackAsItWas) {
  const BenchResult given = some_result("mine", {0.1, -1.0, 1e-300, 1.0 / 3.0});
  const std::string line = to_line(given);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const BenchResult read = parse_bench_result(line, "");
  EXPECT_EQ(to_line(read), line);
  EXPECT_EQ(read.version, given.version);
  EXPECT_EQ(read.kind, Kind::rate);
  ASSERT_EQ(read.draws.size(), 4u);
  EXPECT_EQ(read.draws[1].seed, 18446744073709551615u);
  EXPECT_EQ(read.draws[1].status, OutcomeStatus::crashed);
  EXPECT_EQ(read.draws[3].values.at(testing::kError), 1.0 / 3.0);
}

TEST(BenchResult, WhatIsNotFiniteIsLeftOut) {
  BenchResult result = some_result("mine", {0.1});
  result.draws[0].values["ate_m"] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(parse_bench_result(to_line(result), "").draws[0].values.contains("ate_m"));
}

TEST(BenchResult, OtherLinesAreRefusedWithPlace) {
  const std::string good = to_line(some_result("mine", {0.1, 0.2}));
  EXPECT_EQ(refusal(good), "");
  EXPECT_THAT(refusal(good.substr(0, good.size() / 2)), HasSubstr("a.jsonl:3: "));
  EXPECT_THAT(refusal("{}"), HasSubstr("tumble bench"));
  EXPECT_THAT(refusal("[1]"), HasSubstr("tumble bench"));
  EXPECT_THAT(refusal(replaced(good, "\"format_version\":1", "\"format_version\":2")), HasSubstr("must be 1"));
  EXPECT_THAT(refusal(replaced(good, "\"kind\":\"rate\"", "\"kind\":\"speed\"")), HasSubstr("speed"));
  EXPECT_THAT(refusal(replaced(good, "\"status\":\"ok\"", "\"status\":\"fine\"")), HasSubstr("fine"));
  EXPECT_THAT(refusal(replaced(good, "\"seed\":1", "\"seed\":\"1\"")), HasSubstr("type"));
  EXPECT_THAT(refusal(replaced(good, "\"seed\":1,", "\"seed\":18446744073709551615,")), HasSubstr("occurs twice"));
  EXPECT_THAT(refusal(replaced(good, ":0.1}", ":\"0.1\"}")), HasSubstr("not a finite number"));
  EXPECT_THAT(refusal(replaced(good, "\"date\":", "\"dates\":")), HasSubstr("date"));
}

class BenchResults : public test::TemporaryFolder {};

TEST_F(BenchResults, AreStoredEachInThePlaceOfItsMethod) {
  const auto file = folder_ / "small.jsonl";
  EXPECT_TRUE(read_bench_results(file).empty());
  store_bench_results(file, {some_result("a", {1.0}), some_result("b", {2.0})});
  store_bench_results(file, {some_result("c", {3.0}), some_result("a", {4.0})});
  const std::vector<BenchResult> stored = read_bench_results(file);
  ASSERT_EQ(stored.size(), 3u);
  EXPECT_EQ(stored[0].method, "a");
  EXPECT_EQ(stored[0].draws[0].values.at(testing::kError), 4.0);
  EXPECT_EQ(stored[2].method, "c");
  write("bad.jsonl", to_line(stored[0]) + "\n\nnonsense\n");
  try {
    read_bench_results(folder_ / "bad.jsonl");
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("bad.jsonl:3"));
  }
}

// The test checks that the standard suites never change, and that the results in the repository belong to them.
/// When a digest differs, the suite was changed. Published results belong to the old suite: restore it, and add a
/// successor with another version.
const std::map<Kind, std::string> kDigests = {{Kind::rate, "dc13261d5f058cc69759763879448e51"},
                                              {Kind::attitude, "c48d311ba1ac626af0433af99f04e552"},
                                              {Kind::position, "489bd161b35d595dade7d9c9d5e3889a"},
                                              {Kind::slam, "b6d6b73d7e10d7810a916abafc7fc02d"}};

class BenchSuites : public ::testing::TestWithParam<Kind> {
 protected:
  const DataRoot data_{test::source_dir()};
  const Suite suite_ = load_suite(data_, bench_suite_name(GetParam()));
};

TEST_P(BenchSuites, AreWhatTheyWere) {
  EXPECT_EQ(bench_suite_digest(suite_), kDigests.at(GetParam()));
}

TEST_P(BenchSuites, Have24DrawsAThirdOfEachClass) {
  ASSERT_EQ(suite_.classes.size(), 3u);
  EXPECT_EQ(suite_.classes[0].name, "mild");
  EXPECT_EQ(suite_.classes[1].name, "medium");
  EXPECT_EQ(suite_.classes[2].name, "wild");
  for (const DrawClass& each : suite_.classes) EXPECT_EQ(each.draws.size(), 8u) << each.name;
}

TEST_P(BenchSuites, StoredResultsAreOfThem) {
  const std::vector<BenchResult> stored = read_bench_results(bench_results_file(data_, suite_.name));
  EXPECT_FALSE(stored.empty());
  for (const BenchResult& each : stored) {
    EXPECT_EQ(each.kind, GetParam());
    EXPECT_NO_THROW(require_of_suite(each, suite_)) << each.method;
    EXPECT_EQ(other_recording(stored.front(), each), "") << each.method;
    for (const BenchDraw& draw : each.draws)
      EXPECT_NE(draw.status, OutcomeStatus::killed) << "says nothing of a method";
  }
}

INSTANTIATE_TEST_SUITE_P(All, BenchSuites, ::testing::Values(Kind::rate, Kind::attitude, Kind::position, Kind::slam),
                         [](const auto& each) { return std::string(to_string(each.param)); });

}  // namespace
}  // namespace tumble::scenarios
