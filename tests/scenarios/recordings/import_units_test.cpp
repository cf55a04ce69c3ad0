// SPDX-License-Identifier: BSD-3-Clause
// The test checks rates and stamps in another unit than stated, which a rolling sphere's readings reveal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <sstream>

#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"

namespace tumble::scenarios {
namespace {

using testing::HasSubstr;

/// Returns a table of a sphere that turns about y, so that gravity turns the other way in its axes; the stamps have
/// steps of `step_ns`.
std::string rolled(double rate_rad_s, double written_for_one, std::int64_t step_ns = 4'000'000) {
  std::ostringstream text;
  text << "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (std::int64_t k = 0; k < 1000; ++k) {
    const double angle = rate_rad_s * 0.004 * static_cast<double>(k);
    text << k * step_ns / 1'000'000'000 << ',' << k * step_ns % 1'000'000'000 << ",0," << rate_rad_s * written_for_one
         << ",0," << -9.81 * std::sin(angle) << ",0," << 9.81 * std::cos(angle) << '\n';
  }
  return text.str();
}

class ImportSphere : public fixture::Folder {
 protected:
  Imported import(const std::string& text, double range_rad_s, GyroUnit unit = GyroUnit::rad_s) {
    fixture::put(folder_ / "sphere.csv", text);
    sim::ImuRecord device;
    device.name = "imu";
    device.stated_gyro_range_rad_s = range_rad_s;
    return import_imu_csv(folder_ / "sphere.csv", device, AccelUnit::m_s2, unit);
  }
  std::string complaint_of(const std::string& text, double range_rad_s, GyroUnit unit = GyroUnit::rad_s) {
    return fixture::complaint([&] { import(text, range_rad_s, unit); });
  }
};

// within 0.2 s the sphere turns too far for the windows; a range of 150 rad/s admits 229
TEST_F(ImportSphere, RatesInDegreesAreMetByTheTurning) {
  constexpr double kDegrees = 57.29577951308232;
  const Imported good = import(rolled(4.0, 1.0), 150.0);
  EXPECT_EQ(gravity_rotation(good.sensors.imus[0], RotationWindows::even).windows, 0);
  EXPECT_THAT(good.notes, testing::Contains(HasSubstr("gyro and accelerometer agree in units and axes")));
  EXPECT_THAT(complaint_of(rolled(4.0, kDegrees), 150.0), HasSubstr("The rates may be in deg/s"));
  EXPECT_EQ(complaint_of(rolled(4.0, kDegrees), 150.0, GyroUnit::deg_s), "");
  EXPECT_THAT(complaint_of(rolled(4.0, 1.0), 150.0, GyroUnit::deg_s), HasSubstr("The rates may be in rad/s"));
}

TEST_F(ImportSphere, RatesBeyondTheRangeAreAnotherUnit) {
  EXPECT_THAT(complaint_of(rolled(5.0, 57.3), 7.854), testing::AllOf(HasSubstr("100 % of the rates exceed 15.7 rad/s"),
                                                                     HasSubstr("The rates may be in deg/s")));
  EXPECT_THAT(complaint_of(rolled(5.0, 57.3), 0.0), HasSubstr("exceed 100 rad/s (above any robot's rate)"));
  EXPECT_THAT(complaint_of(rolled(5.0, 7505.0), 7.854), HasSubstr("The rates may be in raw counts of the sensor"));
  EXPECT_EQ(complaint_of(rolled(5.0, 1.0), 7.854), "");
}

TEST_F(ImportSphere, ForcesWithoutGravityAreMet) {
  std::string text = "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (int k = 0; k < 100; ++k) text += "0," + std::to_string(k * 10'000'000) + ",0,0,0,0.1,0,0.02\n";
  EXPECT_THAT(complaint_of(text, 7.854), HasSubstr("the readings may be linear acceleration, without gravity"));
  text = "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (int k = 0; k < 300; ++k)
    text += "0," + std::to_string(k * 3'000'000) + ",0,0,0," + (k < 100 ? "0.1" : "1.4") + ",0,0.02\n";
  EXPECT_THAT(complaint_of(text, 7.854),
              testing::AllOf(HasSubstr("the specific force is 0.102 at the start and 1.4 in the median"),
                             testing::Not(HasSubstr("--accel-unit"))))
      << "a robot at rest would measure 1 in g";
}

TEST_F(ImportSphere, AGyroThatReadsNothingIsSaid) {
  EXPECT_THAT(import(rolled(2.5, 0.0), 7.854).notes, testing::Contains(HasSubstr("reads 0 on all axes in all 1000")));
  EXPECT_THAT(import(rolled(2.5, 1.0), 7.854).notes, testing::Not(testing::Contains(HasSubstr("caution"))));
}

// gravity turns about another axis than the gyro reports
TEST_F(ImportSphere, WhatTurnsButNotAsTheGyroSaysIsNotCalledStill) {
  std::string text = rolled(2.5, 1.0);
  text.replace(0, text.find('\n'), "sec,nsec,wy,wx,wz,fx,fy,fz");
  EXPECT_THAT(import(text, 7.854).notes,
              testing::Contains(HasSubstr("gyro and accelerometer measure different rotations")));
}

TEST_F(ImportSphere, StampsInAnotherUnitAreMet) {
  // the stamps are ms and us where seconds are expected, and us where nanoseconds are expected
  for (const std::int64_t step_ns : {4'000'000'000, 4'000'000'000'000})
    EXPECT_THAT(complaint_of(rolled(2.5, 1.0, step_ns), 7.854), HasSubstr("The time stamps may be in another unit"));
  EXPECT_THAT(complaint_of(rolled(2.5, 1.0, 4'000), 7.854),
              HasSubstr("the median time step is 4e-06 s; it must be from 2e-05 to 2 s."));
}

}  // namespace
}  // namespace tumble::scenarios
