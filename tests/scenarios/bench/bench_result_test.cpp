// SPDX-License-Identifier: BSD-3-Clause
// The test checks that the published line is read back unchanged, and that any other line is rejected.
#include "scenarios/bench/bench_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "scenarios/errors.hpp"
#include "tests/complaint.hpp"
#include "tests/scenarios/bench/some_result.hpp"
#include "tests/temporary_folder.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::HasSubstr;
using testing::some_result;

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

class BenchResults : public testing::TemporaryFolder {};

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

}  // namespace
}  // namespace tumble::scenarios
