// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using fixture::kScenario;
using fixture::kSheet;
using fixture::with;

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
  const std::string message = test::complaint([&] { draw_given(scenario, sheets, 1); });
  EXPECT_EQ(message,
            "hill.yaml:11: sensors.imu_reference: the device 'mti30' is a sensor of kind 'spinning_lidar'; it must be "
            "of kind 'imu'");
}

/// DrawFiles has a data root in a temporary folder.
class DrawFiles : public test::TemporaryFolder {
 protected:
  DrawFiles() {
    fs::create_directories(data_.catalogue());
    fs::create_directories(data_.data_sheets());
  }
  void put(const std::string& name, const std::string& text) { std::ofstream(data_.catalogue() / name) << text; }
  std::string complaint_of(const std::string& name) {
    return test::complaint([&] { load_scenario(data_, name); });
  }
  const DataRoot data_{folder_ / "root"};
};

TEST_F(DrawFiles, NamesAreSortedAndTheNearestIsNamed) {
  put("hill.yaml", kScenario);
  put("bare.yaml", kScenario);
  put("notes.txt", "not a scenario");
  EXPECT_THAT(scenario_names(data_), ElementsAre("bare", "hill"));
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
  DrawReal() { fs::copy(test::tree_data().data_sheets(), data_.data_sheets(), fs::copy_options::recursive); }
  std::string draw_complaint(const std::string& from, const std::string& to, std::uint64_t seed) {
    put("slope.yaml", with(kReal, from, to));
    return test::complaint([&] { draw(data_, load_scenario(data_, "slope"), seed); });
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

/// Returns the scenario `kReal` with `changes` instead of the values of `kReal`, as a file that extends `slope`.
std::string extending(const std::string& changes) {
  return "name: other\ndoc: a change\nextends: slope\n" + changes;
}

TEST_F(DrawReal, AScenarioInheritsTheValuesOfItsBase) {
  put("slope.yaml", with(kReal, "{type: hill}", "{type: hill, relief_m: 0.1, rock_count: 3}"));
  put("other.yaml", extending("world: {rock_count: 4}\nmotion: {type: throw}\nsensors:\n"
                              "  - {name: lidar, range_noise_m: 0.02, mount_error: {x_m: 0.001}}\n"
                              "  - {name: imu, mount_error: {y_m: 0.002}}\n"
                              "  - {name: imu_2, kind: imu, device: vn100, site: vn100}\n"));
  const Scenario base = load_scenario(data_, "slope"), other = load_scenario(data_, "other");
  EXPECT_EQ(other.name, "other");
  EXPECT_EQ(other.duration_s, base.duration_s);
  EXPECT_EQ(other.world.type, "hill");
  EXPECT_EQ(other.world.numbers.at("relief_m").numbers, std::vector{0.1});
  EXPECT_EQ(other.world.numbers.at("rock_count").numbers, std::vector{4.0});
  EXPECT_EQ(other.motion.type, "throw");
  ASSERT_EQ(other.sensors.size(), 3u);
  EXPECT_EQ(other.sensors[0].device, "mti30");
  EXPECT_EQ(other.sensors[0].mount_error.at("x_m"), base.sensors[0].mount_error.at("x_m"));
  EXPECT_EQ(other.sensors[0].mount_error.at("y_m").numbers, std::vector{0.002});
  EXPECT_EQ(other.sensors[1].numbers.at("range_noise_m").numbers, std::vector{0.02});
  EXPECT_EQ(other.sensors[1].site, "rs16");
  EXPECT_EQ(other.sensors[2].name, "imu_2");
}

TEST_F(DrawReal, AKeyOfTypeOrKindInheritsNothing) {
  put("slope.yaml", with(kReal, "{type: hill}", "{type: hill, relief_m: 0.1}"));
  put("other.yaml", extending("world: {type: hill}\nsensors:\n"
                              "  - {name: lidar, kind: spinning_lidar, device: rs16, site: rs16}\n"));
  const Scenario other = load_scenario(data_, "other");
  EXPECT_TRUE(other.world.numbers.empty());
  EXPECT_TRUE(other.sensors[1].numbers.empty());
}

TEST_F(DrawReal, AScenarioDrawsTheSameNumbersAsItsBase) {
  put("slope.yaml", kReal);
  put("other.yaml", extending(""));
  sim::Situation drawn = draw(data_, load_scenario(data_, "other"), 5);
  drawn.scenario = "slope";
  EXPECT_EQ(drawn, draw(data_, load_scenario(data_, "slope"), 5));
}

TEST_F(DrawReal, ABaseIsInTheFolderOfTheFileOrInTheCatalogue) {
  put("slope.yaml", kReal);
  const fs::path elsewhere = data_.root / "elsewhere";
  fs::create_directories(elsewhere);
  std::ofstream(elsewhere / "slope.yaml") << "name: slope\ndoc: a copy\nextends: slope\nduration_s: 7\n";
  std::ofstream(elsewhere / "other.yaml") << extending("");
  EXPECT_EQ(load_scenario(data_, (elsewhere / "other.yaml").string()).duration_s.numbers, std::vector{7.0});
  fs::remove(elsewhere / "slope.yaml");
  EXPECT_EQ(load_scenario(data_, (elsewhere / "other.yaml").string()).duration_s.numbers, (std::vector{5.0, 6.0}));
}

TEST_F(DrawReal, MistakesWithABaseAreNamedWithFileAndLine) {
  const std::string folder = data_.catalogue().string() + "/";
  const auto other = [&](const std::string& text) {
    put("other.yaml", text);
    return complaint_of("other");
  };
  put("slope.yaml", kReal);
  EXPECT_EQ(other(with(extending(""), "extends: slope", "extends: slop")),
            folder + "other.yaml:3: extends: unknown scenario 'slop'; did you mean 'slope'?");
  EXPECT_THAT(other(extending("world: {slop_rad: 1}\n")), HasSubstr(folder + "other.yaml:4: world.slop_rad: unknown"));
  EXPECT_THAT(other(extending("sensors:\n  - {name: imu_2, device: vn100, site: vn100}\n")),
              HasSubstr(folder + "other.yaml:5: sensors[0]: key 'kind' is missing"));
  EXPECT_THAT(other(extending("sensors:\n  - {name: imu}\n  - {name: imu}\n")),
              HasSubstr(folder + "other.yaml:6: sensors[1]: a sensor with the name 'imu' exists already in line 5"));
  put("slope.yaml", with(kReal, "device: rs16", "device: rs17"));
  put("other.yaml", extending(""));
  EXPECT_THAT(test::complaint([&] { draw(data_, load_scenario(data_, "other"), 5); }),
              HasSubstr(folder + "other.yaml:3: sensors.lidar: unknown device 'rs17'"));
  put("slope.yaml", with(kReal, "world: {type: hill}", "world: {type: hil}"));
  EXPECT_THAT(complaint_of("other"), HasSubstr(folder + "slope.yaml:4: world.type: unknown 'hil'"));
  put("slope.yaml", "name: slope\ndoc: a circle\nextends: other\n");
  EXPECT_EQ(complaint_of("other"), folder +
                                       "slope.yaml:3: extends: the keys 'extends' of scenario 'other' and its bases "
                                       "form a loop; remove one key 'extends'");
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
