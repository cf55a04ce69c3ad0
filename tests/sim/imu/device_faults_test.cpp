// SPDX-License-Identifier: BSD-3-Clause
// Tests faults of a device or its bus: wrong readings, and a start later than the recording.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/imu/imu_parameters.hpp"
#include "tests/sim/imu/simulated_imu.hpp"

namespace tumble::sim {
namespace {

/// A body that rotates about z at 3 rad/s.
Truth spinning(double duration_s) {
  Truth truth;
  for (int k = 0; k <= std::lround(duration_s / 0.0005); ++k) {
    truth.q_WB.emplace_back(Eigen::AngleAxisd(0.0015 * k, Eigen::Vector3d::UnitZ()));
    truth.w_WB_B_rad_s.emplace_back(0.0, 0.0, 3.0);
    truth.v_WB_m_s.emplace_back(Eigen::Vector3d::Zero());
    truth.p_WB_m.emplace_back(Eigen::Vector3d::Zero());
  }
  return truth;
}

SensorSpec plain_imu() {
  SensorSpec sensor;
  sensor.name = "imu";
  sensor.kind = "imu";
  sensor.values = resolve("sensors.imu", {}, imu_parameters());
  return sensor;
}

TEST(Glitches, ReplaceSingleAxesAndNothingElse) {
  SensorSpec sensor = plain_imu();
  const SimulatedImu all = simulated(spinning(20.0), sensor);
  sensor.values.set("glitch_share", 0.05);
  const SimulatedImu r = simulated(spinning(20.0), sensor);
  ASSERT_EQ(r.record.time_ns, all.record.time_ns);
  const double range_rad_s = sensor.values.at("gyro_range_rad_s");
  int spoilt = 0, beyond = 0;
  for (std::size_t k = 0; k < r.record.time_ns.size(); ++k) {
    const int axes = static_cast<int>((r.record.gyro_rad_s[k].array() != all.record.gyro_rad_s[k].array()).count() +
                                      (r.record.accel_m_s2[k].array() != all.record.accel_m_s2[k].array()).count());
    ASSERT_LE(axes, 1) << k;
    spoilt += axes;
    beyond += r.record.gyro_rad_s[k].cwiseAbs().maxCoeff() > range_rad_s ? 1 : 0;
    ASSERT_LE(r.record.gyro_rad_s[k].cwiseAbs().maxCoeff(), 1.5 * range_rad_s) << k;
    ASSERT_EQ(r.truth.gyro_unclipped_rad_s[k], r.record.gyro_rad_s[k]) << "a wild reading is no saturation";
    ASSERT_EQ(r.truth.rate_rad_s[k], all.truth.rate_rad_s[k]);
  }
  EXPECT_NEAR(spoilt, 100, 50);  // 2000 samples: 5 standard errors
  EXPECT_GT(beyond, 5);
}

TEST(StartDelay, ALateDeviceDeliversTheRestOfTheSameReadings) {
  SensorSpec sensor = plain_imu();
  sensor.values.set("gyro_noise_rad_s_sqrt_hz", 1e-3);
  const SimulatedImu all = simulated(spinning(2.0), sensor);
  sensor.values.set("start_delay_s", 0.55);
  const SimulatedImu late = simulated(spinning(2.0), sensor);
  const std::size_t missing = all.record.time_ns.size() - late.record.time_ns.size();
  EXPECT_EQ(missing, 55u);
  for (std::size_t k = 0; k < late.record.time_ns.size(); ++k) {
    ASSERT_EQ(late.record.time_ns[k], all.record.time_ns[k + missing]);
    ASSERT_EQ(late.record.gyro_rad_s[k], all.record.gyro_rad_s[k + missing]);
    ASSERT_EQ(late.truth.rate_rad_s[k], all.truth.rate_rad_s[k + missing]);
  }
}

}  // namespace
}  // namespace tumble::sim
