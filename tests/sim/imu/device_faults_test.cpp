// SPDX-License-Identifier: BSD-3-Clause
// The test checks faults of a device or its bus: wild readings, and a start after that of the recording.
#include "sim/imu/imu_parameters.hpp"
#include "sim/imu/time_stamps.hpp"
#include "tests/sim/imu/simulated_imu.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns a body that turns about z with 3 rad/s.
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

constexpr std::int64_t kPeriod_ns = 10'000'000;

TimeStamps stamps(const std::map<std::string, double>& given, std::uint64_t seed = 1) {
  Values values = resolve("imu", {}, imu_parameters());
  for (const auto& [name, value] : given) values.set(name, value);
  return {values, "sensors.imu", kPeriod_ns, Stream(seed, "test")};
}

TEST(TimeStamps, OffIsTheEndOfTheWindow) {
  TimeStamps exact = stamps({});
  for (std::int64_t k = 1; k < 100; ++k) ASSERT_EQ(exact.stamp(k * kPeriod_ns), k * kPeriod_ns);
}

TEST(TimeStamps, OffsetIsConstant) {
  TimeStamps late = stamps({{"time_offset_s", -0.004}});
  EXPECT_EQ(late.stamp(kPeriod_ns), 6'000'000);
}

TEST(TimeStamps, JitterHasItsSizeAndStampsRise) {
  TimeStamps jittering = stamps({{"time_jitter_s", 0.0016}});
  double sum = 0.0;
  std::int64_t before = 0;
  constexpr int kCount = 20000;
  for (std::int64_t k = 1; k <= kCount; ++k) {
    const std::int64_t stamp = jittering.stamp(k * kPeriod_ns).value();
    ASSERT_GT(stamp, before);
    before = stamp;
    const double error_s = static_cast<double>(stamp - k * kPeriod_ns) * 1e-9;
    ASSERT_LE(std::abs(error_s), 3 * 0.0016 + 1e-9);
    sum += error_s * error_s;
  }
  // the cut at three standard deviations reduces the deviation by 0.7 %; 5 standard errors are 2.5 %
  EXPECT_NEAR(std::sqrt(sum / kCount), 0.0016, 0.032 * 0.0016);
}

TEST(TimeStamps, LossesHaveTheirShareAndLength) {
  TimeStamps lossy = stamps({{"dropout_share", 0.1}, {"dropout_mean_samples", 5.0}});
  int lost = 0, runs = 0;
  bool before = false;
  constexpr int kCount = 200000;
  for (std::int64_t k = 1; k <= kCount; ++k) {
    const bool now = !lossy.stamp(k * kPeriod_ns);
    lost += now ? 1 : 0;
    runs += now && !before ? 1 : 0;
    before = now;
  }
  // for 4000 runs of geometric length, 5 standard errors of their mean are 7 %, and of the share 10 %
  EXPECT_NEAR(static_cast<double>(lost) / kCount, 0.1, 0.01);
  EXPECT_NEAR(static_cast<double>(lost) / runs, 5.0, 0.35);
}

TEST(TimeStamps, RefusesAJitterThatTurnsTimeBack) {
  try {
    stamps({{"time_jitter_s", 0.002}});
    FAIL() << "2 ms of jitter at 10 ms were accepted";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), HasSubstr("sensors.imu.time_jitter_s is 0.002 s; it must be below a sixth"));
  }
}

}  // namespace
}  // namespace tumble::sim
