// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tumble::sim {
namespace {

using Eigen::Vector3d;
constexpr double kGravity_m_s2 = 9.80665;

/// A body that turns about z with a constant rate while its origin moves along x by an acceleration of a sin.
Truth turning(double rate_rad_s, double duration_s, double acceleration_m_s2 = 3.0) {
  Truth truth;
  constexpr double kFrequency_rad_s = 20.0;
  for (int k = 0; k <= std::lround(duration_s / 0.0005); ++k) {
    const double t = k * 0.0005;
    truth.q_WB.emplace_back(Eigen::AngleAxisd(rate_rad_s * t, Vector3d::UnitZ()));
    truth.w_WB_B_rad_s.emplace_back(0, 0, rate_rad_s);
    truth.v_WB_m_s.emplace_back(acceleration_m_s2 / kFrequency_rad_s * (1 - std::cos(kFrequency_rad_s * t)), 0, 0);
    truth.p_WB_m.emplace_back(Vector3d::Zero());
  }
  return truth;
}

SensorSpec ideal(double rate_hz = 100.0) {
  SensorSpec sensor;
  sensor.name = "imu";
  sensor.kind = "imu";
  Values given;
  given.set("output_rate_hz", rate_hz);
  sensor.values = resolve("sensors.imu", given, imu_parameters());
  return sensor;
}

struct Result {
  ImuRecord record;
  ImuTruth truth;
};

Result run(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI = Eigen::Isometry3d::Identity(),
           std::uint64_t seed = 1) {
  Result result;
  simulate_imu(truth, sensor, T_BI, kGravity_m_s2, seed, result.record, result.truth);
  return result;
}

TEST(ImuSimulation, IdealDeviceSaysTheTruth) {
  const Result r = run(turning(12.0, 1.0), ideal());
  ASSERT_EQ(r.record.time_ns.size(), 100u);
  EXPECT_EQ(r.record.period_ns, 10'000'000);
  EXPECT_EQ(r.record.time_ns.front(), 10'000'000);
  EXPECT_EQ(r.record.time_ns.back(), 1'000'000'000);
  EXPECT_EQ(r.record.gyro_rad_s, r.truth.rate_rad_s);
  EXPECT_EQ(r.record.accel_m_s2, r.truth.specific_force_m_s2);
  EXPECT_EQ(r.record.gyro_rad_s, r.truth.gyro_unclipped_rad_s);
  for (const Vector3d& w : r.record.gyro_rad_s) ASSERT_NEAR((w - Vector3d(0, 0, 12)).norm(), 0.0, 1e-9);
  EXPECT_THAT(r.record.clip_flags, testing::Each(0));
}

TEST(ImuSimulation, LeverArmGivesTheCentripetalForce) {
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.translation() = Vector3d(0.1, 0, 0.03);
  const Result r = run(turning(15.0, 0.5, 0.0), ideal(), T_BI);
  // w^2 r towards the axis; the difference over a step of 7.5 mrad is short of it by (0.0075)^2/24 = 2.3e-6
  for (const Vector3d& f : r.record.accel_m_s2) ASSERT_NEAR((f - Vector3d(-22.5, 0, kGravity_m_s2)).norm(), 0.0, 1e-4);
}

TEST(ImuSimulation, MountingTurnsTheAxes) {
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();  // y of I is z of B
  const Result r = run(turning(5.0, 0.1, 0.0), ideal(), T_BI);
  ASSERT_EQ(r.record.gyro_rad_s.size(), 10u);
  EXPECT_NEAR((r.record.gyro_rad_s[5] - Vector3d(0, 5, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((r.record.accel_m_s2[5] - Vector3d(0, kGravity_m_s2, 0)).norm(), 0.0, 1e-9);
}

TEST(ImuSimulation, RailClipsTheReadingAndNotTheTwin) {
  SensorSpec sensor = ideal();
  sensor.values.set("gyro_rail_rad_s", 10.5);
  sensor.values.set("clip_flags", 1);
  const Result clipped = run(turning(12.0, 0.1), sensor), free = run(turning(10.0, 0.1), sensor);
  for (std::size_t k = 0; k < 10; ++k) {
    ASSERT_DOUBLE_EQ(clipped.record.gyro_rad_s[k].z(), 10.5);
    ASSERT_NEAR(clipped.truth.gyro_unclipped_rad_s[k].z(), 12.0, 1e-9);
    ASSERT_EQ(clipped.record.clip_flags[k], 0b000100);
    ASSERT_EQ(free.record.clip_flags[k], 0);
  }
}

TEST(ImuSimulation, RailBeforeTheMeanCutsAnOscillationThatTheMeanHides) {
  Truth truth = turning(0.0, 0.2, 0.0);
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {                      // 200 Hz, two whole periods in each window
    truth.v_WB_m_s[k].x() = 0.05 * std::sin(2 * M_PI * 200.0 * k * 0.0005);  // peaks of 63 m/s^2
    truth.v_WB_m_s[k].x() += 20.0 * k * 0.0005;
  }
  SensorSpec sensor = ideal();
  sensor.values.set("accel_rail_m_s2", 50.0);
  sensor.values.set("clip_flags", 1);
  const Result before = run(truth, sensor);
  sensor.values.set("clip_after_low_pass", 1);
  const Result after = run(truth, sensor);
  ASSERT_EQ(before.record.accel_m_s2.size(), 20u);
  EXPECT_LT(before.record.accel_m_s2[5].x(), 18.0);  // measured 12.98: the upper halves are cut, the lower ones less
  EXPECT_EQ(before.record.clip_flags[5], 0b001000);
  EXPECT_NEAR(after.record.accel_m_s2[5].x(), 20.0, 1e-9);
  EXPECT_EQ(after.record.clip_flags[5], 0);
  EXPECT_NEAR(before.truth.accel_unclipped_m_s2[5].x(), 20.0, 1e-9);
}

TEST(ImuSimulation, TwinHasTheSameNoise) {
  SensorSpec sensor = ideal();
  sensor.values.set("gyro_noise_rad_s_sqrt_hz", 0.01);
  sensor.values.set("gyro_rail_rad_s", 10.5);
  const Result r = run(turning(5.0, 1.0), sensor);
  EXPECT_EQ(r.record.gyro_rad_s, r.truth.gyro_unclipped_rad_s);
  EXPECT_NE(r.record.gyro_rad_s, r.truth.rate_rad_s);
}

TEST(ImuSimulation, NoiseOfAReadingFollowsTheOutputRate) {
  for (const double rate_hz : {100.0, 400.0}) {
    SensorSpec sensor = ideal(rate_hz);
    sensor.values.set("gyro_noise_rad_s_sqrt_hz", 0.01);
    const Result r = run(turning(1.0, 10.0), sensor);
    double sum = 0.0;
    for (std::size_t k = 0; k < r.record.gyro_rad_s.size(); ++k)
      sum += (r.record.gyro_rad_s[k] - r.truth.rate_rad_s[k]).squaredNorm();
    const double n = 3.0 * static_cast<double>(r.record.gyro_rad_s.size()), variance = 1e-4 * rate_hz;
    EXPECT_NEAR(sum / n, variance, 5.0 * std::sqrt(2.0 / n) * variance) << rate_hz << " Hz";  // false alarm 6e-7
  }
}

TEST(ImuSimulation, BiasInForceIsTheErrorOfTheReading) {
  SensorSpec sensor = ideal(2000.0);
  sensor.values.set("accel_bias_turn_on_m_s2", 0.1);
  sensor.values.set("accel_bias_walk_m_s2_sqrt_s", 0.01);
  const Result r = run(turning(1.0, 0.2), sensor);
  ASSERT_EQ(r.record.accel_m_s2.size(), 400u);
  for (std::size_t k = 0; k < 400; ++k) {
    ASSERT_NEAR((r.record.accel_m_s2[k] - r.truth.specific_force_m_s2[k] - r.truth.accel_bias_m_s2[k]).norm(), 0.0,
                1e-12);
  }
  EXPECT_NE(r.truth.accel_bias_m_s2.front(), r.truth.accel_bias_m_s2.back());
}

TEST(ImuSimulation, GyroFeelsTheSpecificForce) {
  SensorSpec sensor = ideal();
  sensor.values.set("gyro_g_sensitivity_s_m", 1e-3);
  const Result r = run(turning(0.0, 0.1, 0.0), sensor);
  ASSERT_FALSE(r.record.gyro_rad_s.empty());
  EXPECT_NEAR((r.record.gyro_rad_s[0] - Vector3d(0, 0, 1e-3 * kGravity_m_s2)).norm(), 0.0, 1e-12);
}

TEST(ImuSimulation, ReadingsAreMultiplesOfTheQuantum) {
  SensorSpec sensor = ideal();
  sensor.values.set("accel_quantum_m_s2", 0.25);
  const Result r = run(turning(3.0, 0.5), sensor);
  ASSERT_EQ(r.record.accel_m_s2.size(), 50u);
  for (std::size_t k = 0; k < 50; ++k) {
    const Vector3d steps = r.record.accel_m_s2[k] / 0.25;
    ASSERT_EQ(steps, Vector3d(steps.array().round()));
    ASSERT_LE((r.record.accel_m_s2[k] - r.truth.specific_force_m_s2[k]).cwiseAbs().maxCoeff(), 0.125 + 1e-12);
  }
}

TEST(ImuSimulation, TimeOffsetMovesTheStampsAlone) {
  SensorSpec sensor = ideal();
  const Result exact = run(turning(3.0, 0.1), sensor);
  sensor.values.set("time_offset_s", -0.004);
  const Result late = run(turning(3.0, 0.1), sensor);
  EXPECT_EQ(late.record.time_ns.front(), 6'000'000);
  EXPECT_EQ(late.record.gyro_rad_s, exact.record.gyro_rad_s);
}

TEST(ImuSimulation, SeedAndNameDecideTheNoise) {
  SensorSpec sensor = ideal();
  sensor.values.set("gyro_noise_rad_s_sqrt_hz", 0.01);
  const auto same_T = Eigen::Isometry3d::Identity();
  const Result a = run(turning(3.0, 0.1), sensor, same_T, 1), again = run(turning(3.0, 0.1), sensor, same_T, 1);
  const Result b = run(turning(3.0, 0.1), sensor, same_T, 2);
  sensor.name = "imu_2";
  const Result c = run(turning(3.0, 0.1), sensor, same_T, 1);
  EXPECT_EQ(a.record.gyro_rad_s, again.record.gyro_rad_s);
  EXPECT_NE(a.record.gyro_rad_s, b.record.gyro_rad_s);
  EXPECT_NE(a.record.gyro_rad_s, c.record.gyro_rad_s);
}

TEST(ImuSimulation, RefusesARateThatDoesNotDivideThePhysics) {
  try {
    run(turning(1.0, 0.1), ideal(300.0));
    FAIL() << "300 Hz was accepted";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("sensors.imu.output_rate_hz is 300"));
  }
}

}  // namespace
}  // namespace tumble::sim
