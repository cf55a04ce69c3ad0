// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/complication.hpp"

#include "scenarios/draw/fixed_scenario.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

Scenario fixed(const std::string& name) {
  const Scenario scenario = load_scenario(test::tree_data(), name);
  return fixed_as(scenario, draw(test::tree_data(), scenario, 1));
}

/// The test checks, for every scenario, that each complication can be removed alone, that the remaining scenario can be
/// drawn, and that no part of the complication remains.
TEST(Complications, EachGoesAndTheDrawStays) {
  // testing all scenarios takes many seconds
  const std::set<std::string> one_of_a_robot = {"hill_consumer", "slip", "swing"};
  for (const std::string& name : scenario_names(test::tree_data())) {
    const Scenario scenario = fixed(name);
    const std::vector<Complication> all = complications(scenario);
    EXPECT_GT(all.size(), 5u) << name;
    std::set<std::string> names;
    Scenario simple = scenario;
    for (const Complication& each : all) {
      EXPECT_TRUE(names.insert(each.name).second) << each.name;
      Scenario without = scenario;
      take_away(each, without);
      if (one_of_a_robot.contains(name)) {
        EXPECT_NO_THROW(draw(test::tree_data(), without, 1)) << name << ", " << each.name;
      }
      const std::vector<Complication> left = complications(without);
      EXPECT_EQ(left.size(), all.size() - 1) << name << ", " << each.name;
      EXPECT_TRUE(std::none_of(left.begin(), left.end(), [&](const Complication& l) { return l.name == each.name; }));
      take_away(each, simple);
    }
    EXPECT_THAT(complications(simple), IsEmpty()) << name;
    EXPECT_NO_THROW(draw(test::tree_data(), simple, 1)) << name;
  }
}

/// The test above would not find a line with numbers that no sensor type has.
TEST(Complications, TheErrorsOfTheRigsSensorsAreThere) {
  std::set<std::string> names;
  for (const Complication& each : complications(fixed("hill_consumer"))) names.insert(each.name);
  for (const Complication& each : complications(fixed("hill"))) names.insert(each.name);
  for (const char* name :
       {"world: rocks", "world: trunks", "world: relief", "robot: offset of the centre of mass", "motion: forward spin",
        "sensors.imu: rail of the gyro", "sensors.imu: misalignment, scale and offset of the sensing elements",
        "sensors.imu: white noise", "sensors.imu: bias", "sensors.imu: delay and clock error",
        "sensors.imu_reference: all errors of this sensor", "sensors.lidar: range noise",
        "sensors.lidar: mounting errors"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Complications, CountsAndSizesHaveTheirAmount) {
  const Scenario scenario = fixed("hill");
  const std::vector<Complication> all = complications(scenario);
  const auto named = [&](const std::string& name) {
    return *std::find_if(all.begin(), all.end(), [&](const Complication& each) { return each.name == name; });
  };
  EXPECT_EQ(named("world: rocks").amount, scenario.world.numbers.at("rock_count").numbers.front());
  EXPECT_TRUE(named("world: rocks").whole);
  EXPECT_FALSE(named("world: relief").whole);
  EXPECT_FALSE(named("sensors.imu: bias").amount.has_value());
}

}  // namespace
}  // namespace tumble::scenarios
