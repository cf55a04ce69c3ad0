// SPDX-License-Identifier: BSD-3-Clause
// Tests the health of TumblingOdometry during a throw.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "live_readings.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

// With an inverted accelerometer, gravity still rotates as the gyro measures. Only the forces in flight reveal the
// inversion.
TEST(Health, FindsAnInvertedAccelerometer) {
  ThrownBody body;
  body.rail_rad_s = 20.0;  // the gyro measures the rate of the flight
  TumblingOdometry sound(params_of(body)), mirrored(params_of(body));
  for (ImuSample sample : test::noisy(body.imu(), body.rail_rad_s)) {
    ASSERT_TRUE(sound.add_imu(sample).ok());
    sample.specific_force_m_s2 *= -1.0;
    ASSERT_TRUE(mirrored.add_imu(sample).ok());
  }
  EXPECT_TRUE(sound.health().ok()) << sound.health().worst_message();
  EXPECT_NE(mirrored.health().worst_message().find("agrees with an inverted accelerometer"), std::string::npos)
      << mirrored.health().worst_message();
}

// From a time within the flight on, gyro axis x repeats its reading, like a sensor that failed.
TEST(Health, NamesAFrozenAxis) {
  const ThrownBody body;
  TumblingOdometry::Params params = params_of(body);
  params.imu.gyro_range_rad_s = body.rail_rad_s;
  TumblingOdometry odometry(params);
  std::vector<ImuSample> imu = test::noisy(body.imu(), body.rail_rad_s);
  const auto from = static_cast<std::size_t>((body.rest_s + body.push_s) * body.imu_hz);
  double widest_rad_s = 0.0;
  for (std::size_t k = 0; k < imu.size(); ++k) {
    if (k > from) imu[k].angular_velocity_rad_s.x() = imu[from].angular_velocity_rad_s.x();
    ASSERT_TRUE(odometry.add_imu(imu[k]).ok());
    if (k < from) {
      EXPECT_TRUE(odometry.health().ok()) << odometry.health().worst_message();
    }
    if (const auto& rate = odometry.newest_smoothed_rate())
      widest_rad_s = std::max(widest_rad_s, std::sqrt(rate->covariance_rad2_s2(0, 0)));
  }
  ASSERT_FALSE(odometry.health().ok());
  const HealthFinding found = odometry.health().findings.front();
  EXPECT_EQ(found.kind, HealthFinding::Kind::frozen_axis);
  EXPECT_EQ(found.sensor, "imu");
  EXPECT_STREQ(found.axis, "gyro_x");
  EXPECT_EQ(found.since_ns, imu[from].time_ns);
  EXPECT_NE(to_text(found).find("gyro x"), std::string::npos) << to_text(found);
  EXPECT_GT(widest_rad_s, 2.0);
  TumblingOdometry sound(params);  // negative control
  for (const ImuSample& sample : test::noisy(body.imu(), body.rail_rad_s)) {
    ASSERT_TRUE(sound.add_imu(sample).ok());
    EXPECT_TRUE(sound.health().ok());
  }
}

}  // namespace
}  // namespace tumble
