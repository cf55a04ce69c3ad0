// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario_text.hpp"

namespace tumble::scenarios {
namespace {

using fixture::kScenario;
using fixture::kSheet;
using fixture::with;
using testing::HasSubstr;

sim::Situation draw_text(const std::string& text, std::uint64_t seed) {
  const Scenario scenario = parse_scenario(text, "hill.yaml", fixture::registry());
  const std::vector<DataSheet> sheets(scenario.sensors.size(), parse_data_sheet(kSheet, "mti30.yaml", fixture::registry()));
  return draw_given(scenario, sheets, seed);
}

TEST(Draw, FixesEveryNumber) {
  const sim::Situation situation = draw_text(kScenario, 3);
  EXPECT_EQ(situation.scenario, "hill");
  EXPECT_EQ(situation.seed, 3u);
  EXPECT_EQ(situation.duration_s, 11.0);
  EXPECT_GE(situation.world.values.at("slope_rad"), 0.5);
  EXPECT_LE(situation.world.values.at("slope_rad"), 0.7);
  EXPECT_EQ(situation.motion.values.at("force_n"), 450.5);
  ASSERT_EQ(situation.sensors.size(), 2u);
  EXPECT_EQ(situation.sensors[0].values.at("gyro_range_rad_s"), 7.854) << "of the data sheet";
  EXPECT_EQ(situation.sensors[0].values.at("output_rate_hz"), 100.0) << "the scenario's change";
  EXPECT_EQ(situation.sensors[1].values.at("output_rate_hz"), 400.0) << "of the data sheet";
  EXPECT_NE(situation.sensors[0].mount_error.at("x_m"), 0.0);
}

TEST(Draw, SeedDecides) {
  EXPECT_EQ(draw_text(kScenario, 3), draw_text(kScenario, 3));
  EXPECT_NE(draw_text(kScenario, 3).world, draw_text(kScenario, 4).world);
}

TEST(Draw, AddedNumbersAndSensorsLeaveTheOthersAlone) {
  const sim::Situation before = draw_text(kScenario, 3);
  const std::string more_numbers = with(kScenario, "type: hill,", "type: hill, relief_m: {uniform: [0.1, 0.2]},");
  const std::string more = with(more_numbers, "sensors:\n",
                                "sensors:\n  - {name: a, kind: imu, device: mti30, site: a, mount_error: {x_m: {normal: [0, 0.01]}}}\n");
  const sim::Situation after = draw_text(more, 3);
  EXPECT_EQ(after.world.values.at("slope_rad"), before.world.values.at("slope_rad"));
  EXPECT_EQ(after.robot, before.robot);
  ASSERT_EQ(after.sensors.size(), 3u);
  EXPECT_EQ(after.sensors[1], before.sensors[0]);
  // negative control: equal distributions in different places differ
  EXPECT_NE(after.sensors[0].mount_error.at("x_m") * 0.3, after.sensors[1].mount_error.at("x_m"));
}

TEST(Draw, RefusesADeviceOfAnotherKind) {
  const Scenario scenario = parse_scenario(kScenario, "hill.yaml", fixture::registry());
  std::vector<DataSheet> sheets(2, parse_data_sheet(kSheet, "mti30.yaml", fixture::registry()));
  sheets[1].sensor_kind = "spinning_lidar";
  const std::string message = fixture::complaint([&] { draw_given(scenario, sheets, 1); });
  EXPECT_EQ(message, "hill.yaml:11: sensors.imu_reference: device 'mti30' is of kind 'spinning_lidar', not 'imu'");
}

/// A data root in a folder of its own, gone afterwards.
class DrawFiles : public testing::Test {
 protected:
  DrawFiles() : data_{std::filesystem::path(testing::TempDir()) / "scenarios_draw_tests_root"} {
    std::filesystem::remove_all(data_.root);
    std::filesystem::create_directories(data_.catalogue());
    std::filesystem::create_directories(data_.data_sheets());
  }
  ~DrawFiles() override { std::filesystem::remove_all(data_.root); }
  void put(const std::string& name, const std::string& text) { std::ofstream(data_.catalogue() / name) << text; }
  std::string complaint_of(const std::string& name) {
    return fixture::complaint([&] { load_scenario(data_, name); });
  }
  DataRoot data_;
};

TEST_F(DrawFiles, NamesAreSortedAndTheNearestIsNamed) {
  put("hill.yaml", kScenario);
  put("bare.yaml", kScenario);
  put("notes.txt", "not a scenario");
  EXPECT_THAT(scenario_names(data_), testing::ElementsAre("bare", "hill"));
  EXPECT_EQ(complaint_of("hil"), "unknown scenario 'hil'; did you mean 'hill'?");
  EXPECT_EQ(complaint_of("corridor"), "unknown scenario 'corridor'; known: bare hill");
  EXPECT_THAT(complaint_of("../hill"), HasSubstr("unknown scenario"));
}

TEST_F(DrawFiles, AbsentOrUnreadableFilesAreNamed) {
  EXPECT_EQ(complaint_of("elsewhere/x.yaml"), "elsewhere/x.yaml: no such file");
  EXPECT_THAT(complaint_of(data_.root.string() + ".yaml"), HasSubstr("no such file"));
  put("big.yaml", std::string(5 << 20, '#'));
  EXPECT_THAT(complaint_of("big"), HasSubstr("larger than 4 MiB"));
}

}  // namespace
}  // namespace tumble::scenarios
