// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "sim/simulate.hpp"
#include "tests/scenarios/tree_data.hpp"

namespace tumble::scenarios {
namespace {

// a seed of the range that development looks at
constexpr std::uint64_t kSeed = 1001;

TEST(SlipSuite, HoldsEveryScenarioOfTheSphereAndNoOther) {
  const Suite suite = load_suite(tree_data(), "slip");
  const std::set<std::string> listed(suite.scenarios.begin(), suite.scenarios.end());
  std::size_t spheres = 0;
  for (const std::string& name : scenario_names(tree_data())) {
    const bool sphere = load_scenario(tree_data(), name).robot.type == "sphere";
    EXPECT_EQ(listed.contains(name), sphere) << name;
    spheres += sphere ? 1 : 0;
  }
  EXPECT_GE(spheres, 10u);
}

TEST(SlipSuite, DrawsOnThirtySeeds) {
  for (const std::string& name : load_suite(tree_data(), "slip").scenarios) {
    const Scenario scenario = load_scenario(tree_data(), name);
    for (std::uint64_t seed = kSeed; seed < kSeed + 30; ++seed)
      EXPECT_NO_THROW(draw(tree_data(), scenario, seed)) << name;
  }
}

/// What a scenario is about, in seconds of its labels.
struct SphereExpected {
  const char* scenario;
  double slip_least_s, slip_most_s, slide_least_s, slide_most_s;
};

class SphereScenario : public ::testing::TestWithParam<SphereExpected> {};

// Where a scenario is not about slip it may still scrape: at the edge of an obstacle the sphere has two contacts, of
// which one must slip. Over seeds 1001-1020 bump does so for 0.000-0.135 s, ramp and tube never.
TEST_P(SphereScenario, ShowsWhatItIsAboutAndEndsAtRest) {
  const sim::ResolvedSituation situation =
      draw(tree_data(), load_scenario(tree_data(), GetParam().scenario), kSeed)
          .without_sensors([](const sim::SensorSpec& sensor) { return sensor.kind != "imu"; });
  const sim::Truth truth = sim::simulate(sim::BuiltSituation(situation, tree_data().models())).truth;
  const auto seconds = [&](sim::ContactLabel label) {
    return 1e-9 * static_cast<double>(truth.period_ns) *
           static_cast<double>(std::count(truth.label.begin(), truth.label.end(), label));
  };
  EXPECT_GE(seconds(sim::ContactLabel::slip), GetParam().slip_least_s);
  EXPECT_LE(seconds(sim::ContactLabel::slip), GetParam().slip_most_s);
  EXPECT_GE(seconds(sim::ContactLabel::slide), GetParam().slide_least_s);
  EXPECT_LE(seconds(sim::ContactLabel::slide), GetParam().slide_most_s);
  for (const std::size_t k : {std::size_t{0}, truth.q_WB.size() - 1}) {
    EXPECT_LT(truth.v_WB_m_s[k].norm(), 0.01);
    EXPECT_LT(truth.w_WB_B_rad_s[k].norm(), 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Catalogue, SphereScenario,
    ::testing::Values(SphereExpected{"roll", 0.0, 0.0, 0.0, 0.0}, SphereExpected{"slip", 0.2, 2.5, 0.0, 0.1},
                      SphereExpected{"slip_long", 1.2, 3.0, 0.0, 0.1}, SphereExpected{"slide", 0.0, 0.3, 0.2, 2.2},
                      SphereExpected{"slide_long", 0.0, 0.1, 1.2, 3.0},
                      SphereExpected{"slide_then_roll", 0.0, 0.1, 0.2, 1.5}, SphereExpected{"bump", 0.0, 0.2, 0.0, 0.1},
                      SphereExpected{"ramp", 0.0, 0.1, 0.0, 0.1}, SphereExpected{"corridor", 0.0, 0.0, 0.0, 0.0},
                      SphereExpected{"tube", 0.0, 0.1, 0.0, 0.1}),
    [](const auto& test) { return std::string(test.param.scenario); });

}  // namespace
}  // namespace tumble::scenarios
