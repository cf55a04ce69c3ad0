// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using fixture::kScenario;
using fixture::kSheet;
using fixture::with;
using testing::HasSubstr;

sim::Situation draw_text(const std::string& text, std::uint64_t seed) {
  const Scenario scenario = parse_scenario(text, "hill.yaml", fixture::registry());
  const std::vector<DataSheet> sheets(scenario.sensors.size(),
                                      parse_data_sheet(kSheet, "mti30.yaml", fixture::registry()));
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
  const std::string more =
      with(more_numbers, "sensors:\n",
           "sensors:\n  - {name: a, kind: imu, device: mti30, site: a, mount_error: {x_m: {normal: [0, 0.01]}}}\n");
  const sim::Situation after = draw_text(more, 3);
  EXPECT_EQ(after.world.values.at("slope_rad"), before.world.values.at("slope_rad"));
  EXPECT_EQ(after.robot, before.robot);
  ASSERT_EQ(after.sensors.size(), 3u);
  EXPECT_EQ(after.sensors[1], before.sensors[0]);
  // negative control: equal distributions at different positions give different numbers
  EXPECT_NE(after.sensors[0].mount_error.at("x_m") * 0.3, after.sensors[1].mount_error.at("x_m"));
}

TEST(Draw, RefusesADeviceOfAnotherKind) {
  const Scenario scenario = parse_scenario(kScenario, "hill.yaml", fixture::registry());
  std::vector<DataSheet> sheets(2, parse_data_sheet(kSheet, "mti30.yaml", fixture::registry()));
  sheets[1].sensor_kind = "spinning_lidar";
  const std::string message = fixture::complaint([&] { draw_given(scenario, sheets, 1); });
  EXPECT_EQ(message,
            "hill.yaml:11: sensors.imu_reference: the device 'mti30' is a sensor of kind 'spinning_lidar'; it must be "
            "of kind 'imu'");
}

/// DrawFiles has a data root in a temporary folder.
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
  EXPECT_EQ(complaint_of("corridor"), "unknown scenario 'corridor'; known names: bare hill");
  EXPECT_THAT(complaint_of("../hill"), HasSubstr("unknown scenario"));
}

TEST_F(DrawFiles, AbsentOrUnreadableFilesAreNamed) {
  EXPECT_EQ(complaint_of("elsewhere/x.yaml"), "elsewhere/x.yaml: no such file");
  EXPECT_THAT(complaint_of(data_.root.string() + ".yaml"), HasSubstr("no such file"));
  put("big.yaml", std::string(5 << 20, '#'));
  EXPECT_THAT(complaint_of("big"), HasSubstr("larger than 4 MiB"));
}

/// This scenario uses the simulation's own registries and the project's data sheets.
const std::string kReal = R"(name: slope
doc: a rig is pushed down a hill
duration_s: {uniform: [5, 6]}
world: {type: hill}
robot: {type: rig}
motion: {type: push}
sensors:
  - {name: imu, kind: imu, device: mti30, site: mti30, mount_error: {x_m: {normal: [0, 0.003]}}}
  - {name: lidar, kind: spinning_lidar, device: rs16, site: rs16, range_noise_m: 0.01}
)";

class DrawReal : public DrawFiles {
 protected:
  DrawReal() {
    std::filesystem::copy(DataRoot{test::source_dir()}.data_sheets(), data_.data_sheets(),
                          std::filesystem::copy_options::recursive);
  }
  std::string draw_complaint(const std::string& from, const std::string& to, std::uint64_t seed) {
    put("slope.yaml", with(kReal, from, to));
    return fixture::complaint([&] { draw(data_, load_scenario(data_, "slope"), seed); });
  }
};

TEST_F(DrawReal, TheSituationIsCompleteAndFromTheDataSheets) {
  put("slope.yaml", kReal);
  const sim::ResolvedSituation resolved = draw(data_, load_scenario(data_, "slope"), 5);
  const sim::Situation& situation = resolved;
  EXPECT_EQ(sim::resolve(situation), resolved) << "resolved already";
  EXPECT_FALSE(situation.world.values.all().empty()) << "defaults are filled in";
  ASSERT_EQ(situation.sensors.size(), 2u);
  for (const DataSheet::Entry& entry : load_data_sheet(data_, "rs16").entries) {
    EXPECT_EQ(situation.sensors[1].values.at(entry.name), entry.name == "range_noise_m" ? 0.01 : entry.value)
        << entry.name;
  }
  EXPECT_EQ(situation.sensors[0].mount_error.at("y_m"), 0.0);
  EXPECT_NE(situation.sensors[0].mount_error.at("x_m"), 0.0);
  EXPECT_EQ(situation_from_yaml(to_yaml(situation), "a"), situation);
  EXPECT_EQ(draw(data_, load_scenario(data_, (data_.catalogue() / "slope.yaml").string()), 5), resolved) << "by path";
}

TEST_F(DrawReal, WhatOnlyShowsWhenDrawnIsNamed) {
  EXPECT_EQ(draw_complaint("{type: rig}", "{type: rig}", 5), "");
  EXPECT_THAT(draw_complaint("device: rs16", "device: rs17", 5),
              HasSubstr("slope.yaml:9: sensors.lidar: unknown device 'rs17'; did you mean 'rs16'?"));
  EXPECT_THAT(draw_complaint("device: rs16", "device: mti30", 5),
              HasSubstr("is a sensor of kind 'imu'; it must be of kind 'spinning_lidar'"));
  EXPECT_THAT(draw_complaint("[0, 0.003]", "[0, 1e6]", 5), HasSubstr("slope.yaml: simulated run with seed 5: "));
  EXPECT_THAT(draw_complaint("name: slope", "name: slop", 5),
              HasSubstr("name is 'slop'; it must be the name of the file, 'slope'"));
}

}  // namespace
}  // namespace tumble::scenarios
