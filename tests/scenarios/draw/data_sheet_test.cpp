// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/data_sheet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using fixture::kSheet;
using fixture::with;
using fixture::Wrong;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::StartsWith;

TEST(DataSheet, ReadsValuesWithUnitAndSource) {
  const DataSheet sheet = parse_data_sheet(kSheet, "mti30.yaml", fixture::registry());
  EXPECT_EQ(sheet.device, "mti30");
  EXPECT_EQ(sheet.title, "Xsens MTi-30 AHRS");
  EXPECT_EQ(sheet.sensor_kind, "imu");
  ASSERT_EQ(sheet.entries.size(), 2u);
  EXPECT_EQ(sheet.entries[0].name, "gyro_range_rad_s");
  EXPECT_EQ(sheet.entries[0].value, 7.854);
  EXPECT_EQ(sheet.entries[0].unit, "rad/s");
  EXPECT_EQ(sheet.entries[0].source, "450 deg/s, MTi user manual");
  EXPECT_EQ(sheet.values().at("output_rate_hz"), 400.0);
}

class WrongSheet : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSheet, IsRefusedWithFileLineAndReason) {
  const Wrong& wrong = GetParam();
  const std::string message = fixture::complaint(
      [&] { parse_data_sheet(with(kSheet, wrong.from, wrong.to), "mti30.yaml", fixture::registry()); });
  EXPECT_THAT(message, StartsWith(wrong.where));
  EXPECT_THAT(message, HasSubstr(wrong.what));
}

INSTANTIATE_TEST_SUITE_P(
    , WrongSheet,
    testing::Values(
        Wrong{"gyro_range_rad_s", "gyro_rang_rad_s",
              "mti30.yaml:5: values.gyro_rang_rad_s: ", "did you mean 'gyro_range_rad_s'?"},
        Wrong{"unit: rad/s", "unit: deg/s",
              "mti30.yaml:5: values.gyro_range_rad_s.unit: ", "is 'deg/s'; it must be 'rad/s'"},
        Wrong{", source: \"450 deg/s, MTi user manual\"", "",
              "mti30.yaml:5: values.gyro_range_rad_s: ", "key 'source' is missing"},
        Wrong{"\"450 deg/s, MTi user manual\"", "\"\"",
              "mti30.yaml:5: values.gyro_range_rad_s.source: ", "must not be empty"},
        Wrong{"value: 7.854, ", "", "mti30.yaml:5: values.gyro_range_rad_s: ", "key 'value' is missing"},
        Wrong{"value: 7.854", "value: seven", "mti30.yaml:5: values.gyro_range_rad_s.value: ", "must be a number"},
        Wrong{"value: 7.854", "value: nan", "mti30.yaml:5: values.gyro_range_rad_s.value: ", "must be finite"},
        Wrong{"value: 7.854", "value: 450",
              "mti30.yaml:5: values.gyro_range_rad_s.value: ", "must be within [0.1, 100]"},
        Wrong{"value: 7.854", "value: 7.854, value: 8", "mti30.yaml:5: values.gyro_range_rad_s: ", "given twice"},
        Wrong{"value: 7.854", "valu: 7.854", "mti30.yaml:5: values.gyro_range_rad_s.valu: ", "did you mean 'value'?"},
        Wrong{"output_rate_hz", "gyro_range_rad_s", "mti30.yaml:6: values: ", "given twice"},
        Wrong{"kind: imu", "kind: imus", "mti30.yaml:3: kind: ", "did you mean 'imu'?"},
        Wrong{"title: Xsens MTi-30 AHRS\n", "", "mti30.yaml:1: ", "key 'title' is missing"},
        Wrong{"title:", "titel:", "mti30.yaml:2: titel: ", "did you mean 'title'?"}));

TEST(DataSheet, UnknownDeviceNamesTheNearest) {
  const DataRoot data{test::source_dir()};
  EXPECT_THAT(device_names(data), IsSupersetOf({"mid100", "rs16"}));
  EXPECT_EQ(fixture::complaint([&] { load_data_sheet(data, "rs17"); }), "unknown device 'rs17'; did you mean 'rs16'?");
  const DataRoot nowhere{"no_such_folder"};
  EXPECT_THAT(fixture::complaint([&] { device_names(nowhere); }), HasSubstr("no_such_folder"));
}

// the simulator would use the default for the missing number, whatever the device has
TEST(DataSheet, ANumberThatIsMissingIsNamed) {
  const DataRoot whole{test::source_dir()}, own{std::filesystem::path(testing::TempDir()) / "data_sheet_without"};
  std::filesystem::create_directories(own.data_sheets());
  std::ifstream sheet(whole.data_sheets() / "mti30.yaml");
  std::ofstream less(own.data_sheets() / "mti30.yaml");
  for (std::string line; std::getline(sheet, line);) {
    if (line.find("  accel_rail_m_s2:") == std::string::npos) less << line << "\n";
  }
  less.close();
  EXPECT_EQ(fixture::complaint([&] { load_data_sheet(whole, "mti30"); }), "");
  EXPECT_THAT(
      fixture::complaint([&] { load_data_sheet(own, "mti30"); }),
      HasSubstr(
          "mti30.yaml: the number 'accel_rail_m_s2' is missing; a data sheet of kind 'imu' must state this number"));
  std::filesystem::remove_all(own.root);
}

// The test checks each data sheet of the project against the registries of this build.
TEST(DataSheet, EverySheetOfTheProjectIsRight) {
  const DataRoot data{test::source_dir()};
  const std::vector<std::string> names = device_names(data);
  ASSERT_FALSE(names.empty());
  for (const std::string& name : names) {
    const DataSheet sheet = load_data_sheet(data, name);
    EXPECT_EQ(sheet.device, name);
    EXPECT_FALSE(sheet.entries.empty()) << name;
  }
}

}  // namespace
}  // namespace tumble::scenarios
