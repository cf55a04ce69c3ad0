// SPDX-License-Identifier: BSD-3-Clause
// The test checks that the library's data sheets agree with models/sensors, where each number has its source.
#include <gtest/gtest.h>

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
  void operator()(double value, const Field& field) {
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
  for (const auto& [sheet, device] : {std::pair{sheets::mti30(), "mti30"},
                                      {sheets::vn100(), "vn100"},
                                      {sheets::phidget1044(), "phidget1044"},
                                      {sheets::mpu6050(), "mpu6050"},
                                      {sheets::bmi088(), "bmi088"},
                                      {sheets::icm20948(), "icm20948"},
                                      {sheets::icm42688(), "icm42688"},
                                      {sheets::mti3(), "mti3"},
                                      {sheets::lsm6dso(), "lsm6dso"},
                                      {sheets::ouster_imu(), "ouster_imu"},
                                      {sheets::mid360_imu(), "mid360_imu"}}) {
    const Compare found = compare(sheet, device);
    EXPECT_EQ(found.count(), 5) << device;
    EXPECT_EQ(found.different(), 0) << device;
  }
}

TEST(LibrarySheets, OfLidarsToo) {
  for (const auto& [sheet, device] : {std::pair{sheets::rs16(), "rs16"},
                                      {sheets::mid40(), "mid40"},
                                      {sheets::mid100(), "mid100"},
                                      {sheets::vlp16(), "vlp16"},
                                      {sheets::xt16(), "xt16"},
                                      {sheets::xt32(), "xt32"},
                                      {sheets::helios32(), "helios32"},
                                      {sheets::os0_64(), "os0_64"},
                                      {sheets::os0_128(), "os0_128"},
                                      {sheets::os1_64(), "os1_64"},
                                      {sheets::os1_128(), "os1_128"},
                                      {sheets::mid360(), "mid360"}}) {
    const Compare found = compare(sheet, device);
    EXPECT_EQ(found.count(), 2) << device;
    EXPECT_EQ(found.different(), 0) << device;
  }
}

// negative control
TEST(LibrarySheets, AnotherNumberIsTold) {
  ImuSheet sheet = sheets::mti30();
  sheet.accel_range_m_s2 = 147.1;
  EXPECT_EQ(compare(sheet, "mti30").different(), 1);
}

}  // namespace
}  // namespace tumble::scenarios
