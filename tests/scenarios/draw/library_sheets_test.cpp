// SPDX-License-Identifier: BSD-3-Clause
// The test checks that the library's data sheets agree with models/sensors, where each number has its source.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "scenarios/draw/data_sheet.hpp"
#include "tests/tree.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble::scenarios {
namespace {

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
  Compare out(load_data_sheet(DataRoot{test::source_dir()}, device).values());
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
