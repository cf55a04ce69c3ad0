// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>

#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tumble::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHeader =
    "state_letter,timestamp_seconds,raw_acceleration_x_gs,raw_acceleration_y_gs,raw_acceleration_z_gs,"
    "raw_angular_rate_x_deg_per_s,raw_angular_rate_y_deg_per_s,raw_angular_rate_z_deg_per_s,"
    "magnetic_field_x_microteslas,magnetic_field_y_microteslas,magnetic_field_z_microteslas\n";

std::string row(const std::string& time, const std::string& rate = "180") {
  return "S," + time + ",0,0,1," + rate + ",0,-90,20,0,-40\n";
}

class Airbrakes : public fixture::Folder {
 protected:
  Imported import(const std::string& text) {
    fixture::put(folder_ / "flight.csv", text);
    return import_airbrakes(folder_ / "flight.csv");
  }
  std::string complaint_of(const std::string& text) {
    return fixture::complaint([&] { import(text); });
  }
};

TEST_F(Airbrakes, ReadsDegreesAndG) {
  const Imported imported = import(kHeader + row("1.0") + row("10.5") + row("10.51") + row("10.51") + row("10.52"));
  const sim::ImuRecord& imu = imported.sensors.imus.at(0);
  EXPECT_THAT(imu.time_ns, ElementsAre(0, 10'000'000, 20'000'000));
  EXPECT_NEAR(imu.gyro_rad_s[0].x(), M_PI, 1e-12);
  EXPECT_NEAR(imu.gyro_rad_s[0].z(), -M_PI / 2.0, 1e-12);
  EXPECT_EQ(imu.accel_m_s2[0], Eigen::Vector3d(0.0, 0.0, 9.80665));
  EXPECT_NEAR(imu.magnetic_field_t.at(2).z(), -40e-6, 1e-15);
  EXPECT_FALSE(imported.reference);
  EXPECT_THAT(
      imported.notes,
      ElementsAre(
          "the recording has 1 gaps of more than 1 s; the import keeps the longest segment: samples 1 to 3 of 4",
          "1 rows have the time stamp of an earlier row and are left out"));
  EXPECT_THAT(imported.info.attribution, HasSubstr("MIT"));
  EXPECT_TRUE(is_airbrakes(folder_ / "flight.csv"));
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, nullptr);
}

TEST_F(Airbrakes, BadInputHasFileLineValueAndBound) {
  const std::string good = kHeader + row("1") + row("2");
  EXPECT_EQ(complaint_of(good), "");
  EXPECT_THAT(complaint_of(good.substr(0, good.size() - 1)), HasSubstr("csv:3: the last line has no line end"));
  EXPECT_THAT(complaint_of(good + row("1.5")), HasSubstr("csv:4: the time stamp (first time stamp + "));
  EXPECT_THAT(complaint_of(good + row("3", "nan")), HasSubstr("csv:4: column raw_angular_rate is not finite"));
  EXPECT_THAT(complaint_of(good + row("3", "x")), HasSubstr("csv:4: column raw_angular_rate must be a number"));
  EXPECT_THAT(complaint_of(good + row("-3")), HasSubstr("csv:4: timestamp_seconds is -3; it must be within 0"));
  EXPECT_THAT(complaint_of(good + "S,3\n"), HasSubstr("csv:4: this line has 2 columns, but the header has 11"));
  std::string missing = good;
  missing.replace(missing.find("raw_angular_rate_y"), 18, "raw_angular_rate_q");
  EXPECT_THAT(complaint_of(missing), HasSubstr("column is missing: raw_angular_rate_y_deg_per_s"));
  std::string doubled = good;
  doubled.replace(doubled.find("raw_angular_rate_y"), 18, "raw_angular_rate_x");
  EXPECT_THAT(complaint_of(doubled), HasSubstr("two columns have the name raw_angular_rate_x_deg_per_s"));
}

double peak_rad_s(const Imported& flight) {
  double peak = 0.0;
  for (const Eigen::Vector3d& w : flight.sensors.imus.at(0).gyro_rad_s) peak = std::max(peak, w.norm());
  return peak;
}

TEST_F(Airbrakes, ReadsTheStandIn) {
  const Imported flight =
      import_airbrakes(test::written(test::data_folders("airbrakes").front()) / test::kStandInFlight);
  EXPECT_EQ(flight.sensors.imus[0].time_ns.size(), 2000u) << "ten rows repeat a stamp, seven come long before";
  EXPECT_NEAR(peak_rad_s(flight), 38.9, 0.1);
  EXPECT_THAT(
      flight.notes,
      ElementsAre(
          "the recording has 1 gaps of more than 1 s; the import keeps the longest segment: samples 7 to 2006 of 2007",
          "10 rows have the time stamp of an earlier row and are left out"));
}

/// AirbrakesPublished tests the published flights where they are available; the suite exists only with them.
class AirbrakesPublished : public ::testing::TestWithParam<std::filesystem::path> {};

INSTANTIATE_TEST_SUITE_P(Flights, AirbrakesPublished, ::testing::ValuesIn(test::published_folders("airbrakes")));
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AirbrakesPublished);

TEST_P(AirbrakesPublished, AreRead) {
  const std::filesystem::path folder = GetParam();
  const Imported flight = import_airbrakes(folder / "jackpot_launch_3.csv");
  EXPECT_EQ(flight.sensors.imus[0].time_ns.size(), 7646u);
  EXPECT_NEAR(peak_rad_s(flight), 38.9, 0.1) << "2229 deg/s";
  const Imported other = import_airbrakes(folder / "government_work_1_airbrakes.csv");
  EXPECT_EQ(other.sensors.imus[0].time_ns.size(), 6853u) << "nine rows repeat a stamp, seven come long before";
}

}  // namespace
}  // namespace tumble::scenarios
