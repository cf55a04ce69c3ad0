// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/chosen_method.hpp"

#include "scenarios/methods/bridge.hpp"
#include "tests/testing.hpp"

namespace tumble::tools {
namespace {

/// Returns two IMUs of 100 Hz, a second long.
sim::Sensors sound() {
  sim::Sensors sensors;
  for (const char* name : {"left", "right"}) {
    sim::ImuRecord& imu = sensors.imus.emplace_back();
    imu.name = name;
    imu.period_ns = 10'000'000;
    imu.stated_gyro_range_rad_s = 10.0;
    for (int k = 0; k < 100; ++k) {
      imu.time_ns.push_back(k * imu.period_ns);
      imu.gyro_rad_s.emplace_back(0.1, 0.0, 0.0);
      imu.accel_m_s2.emplace_back(0.0, 0.0, 9.8);
      imu.clip_flags.push_back(0);
    }
  }
  return sensors;
}

/// Returns the place of the fault in the second IMU's samples.
std::string place_in(const sim::Sensors& sensors) {
  std::vector<ImuSample> samples;
  const Status status = scenarios::bridge::imu_samples(sensors.imus[1], samples);
  EXPECT_FALSE(status.ok());
  return trouble_place(status, sensors);
}

TEST(TroublePlace, NamesTheReading) {
  sim::Sensors sensors = sound();
  for (std::size_t k = 42; k < 48; ++k) sensors.imus[1].gyro_rad_s[k].y() = std::nan("");
  EXPECT_EQ(place_in(sensors), "the affected reading is number 42 of right, at 0.420 s");
  sensors = sound();
  for (std::size_t k = 7; k < 13; ++k) sensors.imus[1].accel_m_s2[k].z() = 1e200;
  EXPECT_EQ(place_in(sensors), "the affected reading is number 7 of right, at 0.070 s");
  sensors = sound();
  sensors.imus[1].gyro_rad_s[98].x() = sensors.imus[1].gyro_rad_s[99].x() = 21.0;
  EXPECT_EQ(place_in(sensors), "the affected reading is number 98 of right, at 0.980 s")
      << "beyond twice the stated range, and it lasts";
  sensors = sound();
  for (std::size_t k = 3; k < 9; ++k) sensors.imus[1].time_ns[k] = sensors.imus[1].time_ns[2];
  EXPECT_EQ(place_in(sensors), "the affected reading is number 3 of right, at 0.020 s");
}

TEST(TroublePlace, NamesTheLongestGap) {
  sim::Sensors sensors = sound();
  for (std::size_t k = 50; k < 100; ++k) sensors.imus[1].time_ns[k] += 2'000'000'000;
  EXPECT_EQ(place_in(sensors), "right has no readings between 0.490 and 2.500 s");
}

TEST(TroublePlace, NamesTheSizeOfSweepsWithoutMap) {
  sim::Sensors sensors = sound();
  sim::LidarRecord& lidar = sensors.lidars.emplace_back();
  lidar.name = "points";
  lidar.sweep_start_ns = {0, 100, 200};
  lidar.sweep_first = {0, 96, 100, 900};
  EXPECT_EQ(trouble_place({ErrorCode::insufficient_data, "lidar.sweeps_registered", 0.0, 1.0}, sensors),
            "the sweeps of points have 96 points (median); a map needs sweeps with at least 100 points");
}

TEST(TroublePlace, OfWhatIsNoReadingIsNone) {
  EXPECT_EQ(trouble_place({ErrorCode::out_of_range, "median time step of the IMU in s", 1.0, 2.0}, sound()), "");
  EXPECT_EQ(trouble_place({ErrorCode::non_finite, "specific_force_m_s2", 1.0, 2.0}, sound()), "") << "none has it";
}

}  // namespace
}  // namespace tumble::tools
