// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/fixed_scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>

#include "tests/complaint.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::HasSubstr;

const DataRoot kData{test::source_dir()};

std::string complaint(const std::string& key, double value) {
  Scenario scenario = load_scenario(kData, "hill");
  return test::complaint([&] { fix_number(scenario, key, value); });
}

TEST(FixNumber, SetsOneNumberAndLeavesTheDrawsOfAllOthersAlone) {
  const sim::Situation before = draw(kData, load_scenario(kData, "hill"), 5001);
  Scenario scenario = load_scenario(kData, "hill");
  fix_number(scenario, "world.trunk_count", 7);
  fix_number(scenario, "sensors.lidar.mount_error.yaw_rad", 0.125);
  fix_number(scenario, "sensors.imu.output_rate_hz", 200);  // the data sheet's value before
  fix_number(scenario, "duration_s", 3);
  sim::Situation after = draw(kData, scenario, 5001);
  EXPECT_EQ(after.world.values.at("trunk_count"), 7.0);
  EXPECT_EQ(after.sensors[2].mount_error.at("yaw_rad"), 0.125);
  EXPECT_EQ(after.sensors[0].values.at("output_rate_hz"), 200.0);
  EXPECT_EQ(after.duration_s, 3.0);
  EXPECT_NE(before.sensors[0].values.at("output_rate_hz"), 200.0) << "or the test shows nothing";
  // after the test restores these numbers by hand, all else is equal
  after.world.values.set("trunk_count", before.world.values.at("trunk_count"));
  after.sensors[2].mount_error.set("yaw_rad", before.sensors[2].mount_error.at("yaw_rad"));
  after.sensors[0].values.set("output_rate_hz", before.sensors[0].values.at("output_rate_hz"));
  after.duration_s = before.duration_s;
  EXPECT_EQ(after, before);
}

TEST(FixNumber, ComplaintsNameTheNearestAndTheBound) {
  EXPECT_THAT(complaint("world.trunk_cont", 7), HasSubstr("did you mean 'trunk_count'"));
  EXPECT_THAT(complaint("world.trunk_count", -1), HasSubstr("must be within [0,"));
  EXPECT_THAT(complaint("world.trunk_count", std::nan("")), HasSubstr("must be within"));
  EXPECT_THAT(complaint("word.trunk_count", 7), HasSubstr("did you mean 'world'"));
  EXPECT_THAT(complaint("sensors.imo.output_rate_hz", 100), HasSubstr("did you mean 'imu'"));
  EXPECT_THAT(complaint("sensors.imu", 100), HasSubstr("names a sensor without a parameter"));
  EXPECT_THAT(complaint("sensors.imu.mount_error.yaw_rd", 0), HasSubstr("did you mean 'yaw_rad'"));
  EXPECT_THAT(complaint("", 0), HasSubstr("the scenario has no number with the key"));
  EXPECT_EQ(complaint("motion.rest_s", 1.0), "") << "or everything is refused";
}

}  // namespace
}  // namespace tumble::scenarios
