// SPDX-License-Identifier: BSD-3-Clause
// The test checks devices that sample: their windows, delays and rates.
#include "sim/imu/sampling.hpp"

#include "sim/imu/imu_simulation.hpp"
#include "tests/sim/imu/simulated_imu.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kSteps_hz = 2000.0;

Sampling sampling(const Sampling::Params& params, std::uint64_t seed = 1) {
  return {params, kSteps_hz, Stream(seed, "test")};
}

Sampling::Reading step(double value, std::uint8_t railed = 0) {
  return {Vector3d::Constant(value), Vector3d::Constant(2.0 * value), railed};
}

TEST(Sampling, IsOffWithoutAWindowOrARateOfItsOwn) {
  EXPECT_FALSE(sampling({}).on());
  EXPECT_TRUE(sampling({.window_s = 0.001}).on());
  EXPECT_TRUE(sampling({.update_hz = 50.0}).on());
}

TEST(Sampling, AWindowIsThePlainMeanOfItsLastSteps) {
  Sampling four = sampling({.window_s = 0.002});
  four.add(step(8.0, 0b001));
  EXPECT_EQ(four.output().delivered.x(), 8.0);  // before the window is full, the mean of the available values
  for (const double value : {1.0, 2.0, 3.0}) four.add(step(value));
  EXPECT_EQ(four.output().delivered, Vector3d::Constant(3.5));
  EXPECT_EQ(four.output().unclipped, Vector3d::Constant(7.0));
  EXPECT_EQ(four.output().railed, 0b001);
  four.add(step(6.0, 0b010));  // the value 8 has left the window
  EXPECT_EQ(four.output().delivered, Vector3d::Constant(3.0));
  EXPECT_EQ(four.output().railed, 0b010);
}

TEST(Sampling, ARateOfItsOwnHoldsTheLastReading) {
  Sampling held = sampling({.window_s = 1.0 / kSteps_hz, .update_hz = 100.0});
  std::vector<double> changes;
  double last = 0.0;
  for (int k = 1; k <= 2000; ++k) {
    held.add(step(k));
    const double now = held.output().delivered.x();
    if (k > 20 && now != last) {
      ASSERT_EQ(now, k);  // a new reading is that of the step
      changes.push_back(k);
    }
    last = now;
  }
  ASSERT_NEAR(static_cast<double>(changes.size()), 99.0, 1.0);
  for (std::size_t i = 1; i < changes.size(); ++i) ASSERT_NEAR(changes[i] - changes[i - 1], 20.0, 1.0);
}

TEST(Sampling, ARateThatDoesNotDivideTheStepsIsKeptOnTheMean) {
  Sampling held = sampling({.window_s = 1.0 / kSteps_hz, .update_hz = 37.0});
  int changes = 0;
  double last = 0.0;
  for (int k = 1; k <= 20000; ++k) {
    held.add(step(k));
    const double now = held.output().delivered.x();
    if (k > 60 && now != last) ++changes;
    last = now;
  }
  EXPECT_NEAR(changes, 370, 3);
}

TEST(Sampling, ThePhaseIsDrawn) {
  const auto first_change = [](std::uint64_t seed) {
    Sampling held = sampling({.window_s = 1.0 / kSteps_hz, .update_hz = 10.0}, seed);
    int k = 0;
    do held.add(step(++k));
    while (k < 400 && (k < 201 || held.output().delivered.x() != k));
    return k;
  };
  EXPECT_EQ(first_change(1), first_change(1));
  EXPECT_NE(first_change(1), first_change(2));
}

/// Returns a turn about z with a rate that rises by 10 rad/s^2 from 1 rad/s, and the same acceleration in m/s^2 along
/// x.
Truth ramp(double duration_s) {
  Truth truth;
  for (int k = 0; k <= std::lround(duration_s * kSteps_hz); ++k) {
    const double t = k / kSteps_hz;
    truth.q_WB.emplace_back(Eigen::AngleAxisd(t + 5.0 * t * t, Vector3d::UnitZ()));
    truth.w_WB_B_rad_s.emplace_back(0.0, 0.0, 1.0 + 10.0 * t);
    truth.v_WB_m_s.emplace_back(0.0, 0.0, t + 5.0 * t * t);
    truth.p_WB_m.emplace_back(Vector3d::Zero());
  }
  return truth;
}

SimulatedImu sampled_ramp(Numbers numbers, double rate_hz = 100.0) {
  return simulated(ramp(1.0), imu_with(numbers, rate_hz));
}

TEST(SampledDevice, AWindowAsLongAsTheOutputsSaysTheSameAboutOneAxis) {
  const SimulatedImu plain = sampled_ramp({}),
                     sampled = sampled_ramp({{"gyro_window_s", 0.01}, {"accel_window_s", 0.01}});
  ASSERT_EQ(sampled.record.gyro_rad_s.size(), 100u);
  for (std::size_t k = 0; k < 100; ++k) {
    ASSERT_NEAR((sampled.record.gyro_rad_s[k] - plain.record.gyro_rad_s[k]).norm(), 0.0, 1e-9);
    ASSERT_NEAR((sampled.record.accel_m_s2[k] - plain.record.accel_m_s2[k]).norm(), 0.0, 1e-9);
    ASSERT_EQ(sampled.record.gyro_rad_s[k], sampled.truth.gyro_unclipped_rad_s[k]);
  }
}

TEST(SampledDevice, WindowsAndDelaysOfGyroAndAccelerometerAreTenMillisecondsApart) {
  // on a ramp, a mean over T is late by T / 2, and a delay by its own length: the truth is the mean over the output's
  // 10 ms
  const SimulatedImu r = sampled_ramp({{"gyro_window_s", 0.03}, {"accel_window_s", 0.0005}, {"accel_delay_s", 0.01}});
  const SimulatedImu late = sampled_ramp({{"gyro_delay_s", 0.01}});
  for (std::size_t k = 5; k < 100; ++k) {
    const double rate = r.truth.rate_rad_s[k].z(), force = r.truth.specific_force_m_s2[k].z();
    ASSERT_NEAR(r.record.gyro_rad_s[k].z(), rate - 10.0 * 0.010, 1e-9);
    ASSERT_NEAR(r.record.accel_m_s2[k].z(), force + 10.0 * (0.00475 - 0.010), 1e-8);
    ASSERT_NEAR(late.record.gyro_rad_s[k].z(), rate - 10.0 * 0.010, 1e-9);
    ASSERT_NEAR(late.record.accel_m_s2[k].z(), force, 1e-9);
  }
}

TEST(SampledDevice, ALogFasterThanItsSensorRepeats) {
  // with 40 readings per second in a log of 100, 60 % repeat the one before
  const SimulatedImu r = sampled_ramp({{"gyro_update_hz", 40.0}, {"accel_update_hz", 25.0}});
  int gyro = 0, accel = 0;
  for (std::size_t k = 4; k < 100; ++k) {
    gyro += r.record.gyro_rad_s[k] == r.record.gyro_rad_s[k - 1];
    accel += r.record.accel_m_s2[k] == r.record.accel_m_s2[k - 1];
    ASSERT_EQ(r.truth.gyro_unclipped_rad_s[k] == r.truth.gyro_unclipped_rad_s[k - 1],
              r.record.gyro_rad_s[k] == r.record.gyro_rad_s[k - 1]);
    ASSERT_NE(r.truth.rate_rad_s[k], r.truth.rate_rad_s[k - 1]);  // the truth continues to change
  }
  EXPECT_NEAR(gyro / 96.0, 0.60, 0.02);
  EXPECT_NEAR(accel / 96.0, 0.75, 0.02);
}

TEST(SampledDevice, HeldReadingsKeepTheirFlags) {
  const SimulatedImu r = sampled_ramp({{"gyro_update_hz", 20.0}, {"gyro_rail_rad_s", 5.0}, {"clip_flags", 1.0}});
  int clipped = 0;
  for (std::size_t k = 6; k < 100; ++k) {
    const bool lost = r.record.gyro_rad_s[k] != r.truth.gyro_unclipped_rad_s[k];
    ASSERT_EQ(r.record.clip_flags[k], lost ? 0b100 : 0) << k;
    if (lost) {
      ASSERT_LE(r.record.gyro_rad_s[k].z(), 5.0 + 1e-12);
    }
    clipped += lost;
  }
  EXPECT_GT(clipped, 40);
}

TEST(SampledDevice, TheSpreadOfTheGSensitivityIsDrawn) {
  const SimulatedImu none = sampled_ramp({}), r = sampled_ramp({{"gyro_g_sensitivity_spread_s_m", 1e-3}});
  // the body does not turn about x and y: the readings there are column z of the matrix times the force
  const Vector3d first = r.record.gyro_rad_s[10] - none.record.gyro_rad_s[10];
  const Vector3d last = r.record.gyro_rad_s[90] - none.record.gyro_rad_s[90];
  const double more = r.truth.specific_force_m_s2[90].z() / r.truth.specific_force_m_s2[10].z();
  EXPECT_NEAR((last - more * first).norm(), 0.0, 1e-9);
  EXPECT_GT(first.cwiseAbs().minCoeff(), 1e-6);
  EXPECT_LT(first.cwiseAbs().maxCoeff(), 3e-3 * r.truth.specific_force_m_s2[10].z());
}

}  // namespace
}  // namespace tumble::sim
