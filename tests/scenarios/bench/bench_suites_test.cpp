// SPDX-License-Identifier: BSD-3-Clause
// The standard suites never change, and the stored results belong to them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "scenarios/bench/bench.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

/// If this digest differs, the suite was changed. Published results belong to the old suite, so keep it and add a suite
/// of a new version.
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
