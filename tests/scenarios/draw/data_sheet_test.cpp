// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/data_sheet.hpp"

#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "tests/scenarios/testing.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble::scenarios {
namespace {

using fixture::kSheet;
using fixture::with;
using fixture::Wrong;
using testing::IsSupersetOf;

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
  const std::string message =
      test::complaint([&] { parse_data_sheet(with(kSheet, wrong.from, wrong.to), "mti30.yaml", fixture::registry()); });
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
  EXPECT_EQ(test::complaint([&] { load_data_sheet(data, "rs17"); }), "unknown device 'rs17'; did you mean 'rs16'?");
  const DataRoot nowhere{"no_such_folder"};
  EXPECT_THAT(test::complaint([&] { device_names(nowhere); }), HasSubstr("no_such_folder"));
}

// the simulator would use the default for the missing number, whatever the device has
using DataSheetFile = test::TemporaryFolder;
TEST_F(DataSheetFile, ANumberThatIsMissingIsNamed) {
  const DataRoot whole = test::tree_data(), own{folder_};
  fs::create_directories(own.data_sheets());
  std::ifstream sheet(whole.data_sheets() / "mti30.yaml");
  std::ofstream less(own.data_sheets() / "mti30.yaml");
  for (std::string line; std::getline(sheet, line);) {
    if (line.find("  accel_rail_m_s2:") == std::string::npos) less << line << "\n";
  }
  less.close();
  EXPECT_EQ(test::complaint([&] { load_data_sheet(whole, "mti30"); }), "");
  EXPECT_THAT(
      test::complaint([&] { load_data_sheet(own, "mti30"); }),
      HasSubstr(
          "mti30.yaml: the number 'accel_rail_m_s2' is missing; a data sheet of kind 'imu' must state this number"));
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

// The test checks that the library's data sheets agree with models/sensors, where each number has its source.
/// Compare compares each number of a library's data sheet with the device of that name.
class Compare {
 public:
  explicit Compare(sim::Values device) : device_(std::move(device)) {}
  void operator()(double value, const ParameterInfo& field) {
    const std::string name = std::string(field.name) == "rate_hz" ? "output_rate_hz" : field.name;
    ASSERT_TRUE(device_.has(name)) << name;
    different_ += value != device_.at(name);
    ++count_;
  }
  int count() const { return count_; }
  int different() const { return different_; }

 private:
  sim::Values device_;
  int count_ = 0, different_ = 0;
};

template <class Sheet>
Compare compare(const Sheet& sheet, const std::string& device) {
  Compare out(load_data_sheet(test::tree_data(), device).values());
  Sheet::fields(sheet, out);
  return out;
}

TEST(LibrarySheets, AreThoseOfTheModels) {
  for (const auto& [device, sheet] : sheets::imus()) {
    const Compare found = compare(sheet, device);
    EXPECT_EQ(found.count(), 5) << device;
    EXPECT_EQ(found.different(), 0) << device;
  }
  for (const auto& [device, sheet] : sheets::lidars()) {
    const Compare found = compare(sheet, device);
    EXPECT_EQ(found.count(), 2) << device;
    EXPECT_EQ(found.different(), 0) << device;
  }
}

TEST(LibrarySheets, HaveEveryImuAndLidarOfTheModels) {
  std::set<std::string> listed;
  for (const auto& [device, sheet] : sheets::imus()) listed.insert(device);
  for (const auto& [device, sheet] : sheets::lidars()) listed.insert(device);
  std::set<std::string> models;
  const DataRoot root{test::source_dir()};
  for (const std::string& device : device_names(root)) {
    const std::string kind = load_data_sheet(root, device).sensor_kind;
    if (kind == "imu" || kind.ends_with("_lidar")) models.insert(device);
  }
  EXPECT_GE(models.size(), 28u);
  EXPECT_EQ(listed, models);
}

// negative control
TEST(LibrarySheets, AnotherNumberIsReported) {
  ImuDataSheet sheet = sheets::mti30();
  sheet.accel_range_m_s2 = 147.1;
  EXPECT_EQ(compare(sheet, "mti30").different(), 1);
}

}  // namespace
}  // namespace tumble::scenarios
