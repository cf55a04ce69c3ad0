// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/selection.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

/// Returns a summary of seeds 1 to 10; the values are ten times the seed, and every third run failed.
Summary ten_draws() {
  MethodSummary method;
  method.method = "raw";
  MetricSummary& metric = method.metrics["error_m"];
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    method.seeds.push_back(seed);
    if (seed % 3 == 0) {
      method.not_ok_seeds.push_back(seed);
      metric.failed.push_back(seed);
    } else {
      metric.seeds.push_back(seed);
      metric.values.push_back(10.0 * static_cast<double>(seed));
    }
  }
  Section section;
  section.scenario = "hill";
  section.methods = {method};
  Summary summary;
  summary.sections = {section};
  return summary;
}

TEST(AtMostDraws, KeepsEveryNthWithAllThatItHas) {
  const Summary some = at_most_draws(ten_draws(), 4);
  const MethodSummary& method = some.sections.front().methods.front();
  EXPECT_THAT(method.seeds, ElementsAre(1, 4, 7, 10));
  EXPECT_THAT(method.not_ok_seeds, IsEmpty());
  EXPECT_THAT(method.metrics.at("error_m").values, ElementsAre(10.0, 40.0, 70.0, 100.0));
  const Summary half = at_most_draws(ten_draws(), 5);
  EXPECT_THAT(half.sections.front().methods.front().metrics.at("error_m").failed, ElementsAre(3, 9));
}

TEST(AtMostDraws, LeavesFewDrawsAsTheyAre) {
  const Summary all = at_most_draws(ten_draws(), 10);
  EXPECT_EQ(all.sections.front().methods.front().seeds.size(), 10u);
  EXPECT_EQ(all.sections.front().methods.front().not_ok_seeds.size(), 3u);
}

}  // namespace
}  // namespace tumble::scenarios
