// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_simulation.hpp"

#include "tests/sim/imu/simulated_imu.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns a body that turns about z with a constant rate while its origin moves along x with an acceleration of a sin.
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

/// Returns a body that swings about an axis near x with up to 12 rad/s and is shaken along x.
Truth swinging(double duration_s) {
  Truth truth = turning(0.0, duration_s, 5.0);
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    const double t = static_cast<double>(k) * 0.0005, angle_rad = 3.0 * (1.0 - std::cos(4.0 * t));
    truth.q_WB[k] = Quaterniond(Eigen::AngleAxisd(angle_rad, Vector3d(0.9, 0.4, 0.174).normalized()));
  }
  return truth;
}

TEST(ImuSimulation, IdealDeviceSaysTheTruth) {
  const SimulatedImu r = simulated(turning(12.0, 1.0), imu_with());
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
  Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.translation() = Vector3d(0.1, 0, 0.03);
  const SimulatedImu r = simulated(turning(15.0, 0.5, 0.0), imu_with(), T_BI);
  // the velocity gain from w^2 r towards the axis, over a turn of 0.15 rad: the chord is shorter than the arc
  const Vector3d expected(-22.5 * std::sin(0.075) / 0.075, 0, kGravity_m_s2);
  ASSERT_EQ(r.record.accel_m_s2.size(), 50u);
  for (const Vector3d& f : r.record.accel_m_s2) ASSERT_NEAR((f - expected).norm(), 0.0, 1e-9);
}

TEST(ImuSimulation, MountingTurnsTheAxes) {
  Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();  // y of I equals z of B
  const SimulatedImu r = simulated(turning(5.0, 0.1, 0.0), imu_with(), T_BI);
  ASSERT_EQ(r.record.gyro_rad_s.size(), 10u);
  EXPECT_NEAR((r.record.gyro_rad_s[5] - Vector3d(0, 5, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((r.record.accel_m_s2[5] - Vector3d(0, kGravity_m_s2, 0)).norm(), 0.0, 1e-9);
}

TEST(ImuSimulation, RailClipsTheReadingAndNotTheTwin) {
  SensorSpec sensor = imu_with({{"gyro_rail_rad_s", 10.5}, {"clip_flags", 1}});
  const SimulatedImu clipped = simulated(turning(12.0, 0.1), sensor), free = simulated(turning(10.0, 0.1), sensor);
  for (std::size_t k = 0; k < 10; ++k) {
    ASSERT_DOUBLE_EQ(clipped.record.gyro_rad_s[k].z(), 10.5);
    ASSERT_NEAR(clipped.truth.gyro_unclipped_rad_s[k].z(), 12.0, 1e-9);
    ASSERT_EQ(clipped.record.clip_flags[k], 0b000100);
    ASSERT_EQ(free.record.clip_flags[k], 0);
  }
}

TEST(ImuSimulation, RailBeforeTheMeanCutsAnOscillationThatTheMeanHides) {
  Truth truth = turning(0.0, 0.2, 0.0);
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {  // 200 Hz, two whole periods in each window
    truth.v_WB_m_s[k].x() = 0.05 * std::sin(2 * M_PI * 200.0 * static_cast<double>(k) * 0.0005);  // peaks of 63 m/s^2
    truth.v_WB_m_s[k].x() += 20.0 * static_cast<double>(k) * 0.0005;
  }
  SensorSpec sensor = imu_with({{"accel_rail_m_s2", 50.0}, {"clip_flags", 1}});
  const SimulatedImu before = simulated(truth, sensor);
  sensor.values.set("clip_after_low_pass", 1);
  const SimulatedImu after = simulated(truth, sensor);
  ASSERT_EQ(before.record.accel_m_s2.size(), 20u);
  // measured 12.98: the upper halves are clipped, the lower ones less
  EXPECT_LT(before.record.accel_m_s2[5].x(), 18.0);
  EXPECT_EQ(before.record.clip_flags[5], 0b001000);
  EXPECT_NEAR(after.record.accel_m_s2[5].x(), 20.0, 1e-9);
  EXPECT_EQ(after.record.clip_flags[5], 0);
  EXPECT_NEAR(before.truth.accel_unclipped_m_s2[5].x(), 20.0, 1e-9);
}

TEST(ImuSimulation, TwinHasTheSameNoise) {
  SensorSpec sensor = imu_with({{"gyro_noise_rad_s_sqrt_hz", 0.01}, {"gyro_rail_rad_s", 10.5}});
  const SimulatedImu r = simulated(turning(5.0, 1.0), sensor);
  EXPECT_EQ(r.record.gyro_rad_s, r.truth.gyro_unclipped_rad_s);
  EXPECT_NE(r.record.gyro_rad_s, r.truth.rate_rad_s);
}

TEST(ImuSimulation, NoiseOfAReadingFollowsTheOutputRate) {
  for (const double rate_hz : {100.0, 400.0}) {
    SensorSpec sensor = imu_with({}, rate_hz);
    sensor.values.set("gyro_noise_rad_s_sqrt_hz", 0.01);
    const SimulatedImu r = simulated(turning(1.0, 10.0), sensor);
    double sum = 0.0;
    for (std::size_t k = 0; k < r.record.gyro_rad_s.size(); ++k)
      sum += (r.record.gyro_rad_s[k] - r.truth.rate_rad_s[k]).squaredNorm();
    const double n = 3.0 * static_cast<double>(r.record.gyro_rad_s.size()), variance = 1e-4 * rate_hz;
    EXPECT_NEAR(sum / n, variance, 5.0 * std::sqrt(2.0 / n) * variance) << rate_hz << " Hz";  // false alarm 6e-7
  }
}

TEST(ImuSimulation, BiasInForceIsTheErrorOfTheReading) {
  SensorSpec sensor = imu_with({{"accel_bias_turn_on_m_s2", 0.1}, {"accel_bias_walk_m_s2_sqrt_s", 0.01}}, 2000.0);
  const SimulatedImu r = simulated(turning(1.0, 0.2), sensor);
  ASSERT_EQ(r.record.accel_m_s2.size(), 400u);
  for (std::size_t k = 0; k < 400; ++k) {
    ASSERT_NEAR((r.record.accel_m_s2[k] - r.truth.specific_force_m_s2[k] - r.truth.accel_bias_m_s2[k]).norm(), 0.0,
                1e-12);
  }
  EXPECT_NE(r.truth.accel_bias_m_s2.front(), r.truth.accel_bias_m_s2.back());
}

TEST(ImuSimulation, GyroFeelsTheSpecificForce) {
  SensorSpec sensor = imu_with({{"gyro_g_sensitivity_s_m", 1e-3}});
  const SimulatedImu r = simulated(turning(0.0, 0.1, 0.0), sensor);
  ASSERT_FALSE(r.record.gyro_rad_s.empty());
  EXPECT_NEAR((r.record.gyro_rad_s[0] - Vector3d(0, 0, 1e-3 * kGravity_m_s2)).norm(), 0.0, 1e-12);
}

TEST(ImuSimulation, ReadingsAtTheRateOfTheConverterAreMultiplesOfTheQuantum) {
  SensorSpec sensor = imu_with({{"accel_quantum_m_s2", 0.25}}, 2000.0);
  const SimulatedImu r = simulated(turning(3.0, 0.5), sensor);
  ASSERT_EQ(r.record.accel_m_s2.size(), 1000u);
  for (std::size_t k = 0; k < 1000; ++k) {
    const Vector3d steps = r.record.accel_m_s2[k] / 0.25;
    ASSERT_NEAR((steps - Vector3d(steps.array().round())).norm(), 0.0, 1e-12);
    ASSERT_LE((r.record.accel_m_s2[k] - r.truth.specific_force_m_s2[k]).cwiseAbs().maxCoeff(), 0.125 + 1e-12);
  }
}

TEST(ImuSimulation, EachOptionOffIsTheIdealSignalAndOnIsNot) {
  const Truth motion = swinging(1.0);
  const SimulatedImu exact = simulated(motion, imu_with());
  ASSERT_EQ(exact.record.gyro_rad_s, exact.truth.rate_rad_s);
  // the list contains every number that makes an error, with a visible size, after the numbers without which it has no
  // effect
  const std::vector<std::vector<std::pair<const char*, double>>> options = {
      {{"gyro_rail_rad_s", 8.0}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_plateau_axis_spread_rad_s", 0.1}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_plateau_event_spread_rad_s", 0.1}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_wrap", 1}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_slow_recovery_s", 0.1}, {"gyro_slow_recovery_share", 0.2}},
      {{"gyro_rail_rad_s", 8.0}, {"clip_after_low_pass", 1}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_element_misalignment", 0.02}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_element_scale", 0.02}},
      {{"gyro_rail_rad_s", 8.0}, {"gyro_element_offset_rad_s", 0.1}},
      {{"gyro_bandwidth_hz", 10.0}},
      {{"gyro_delay_s", 0.003}},
      {{"gyro_noise_rad_s_sqrt_hz", 1e-3}},
      {{"gyro_bias_turn_on_rad_s", 0.01}},
      {{"gyro_bias_in_run_rad_s", 0.01}},
      {{"gyro_bias_walk_rad_s_sqrt_s", 0.01}},
      {{"gyro_scale_error", 0.01}},
      {{"gyro_misalignment_rad", 0.01}},
      {{"gyro_g_sensitivity_s_m", 0.001}},
      {{"gyro_quantum_rad_s", 0.05}},
      {{"gyro_handover_rad_s", 20.0}, {"gyro_precise_noise_rad_s_sqrt_hz", 1e-3}},
      {{"gyro_handover_rad_s", 20.0}, {"gyro_precise_quantum_rad_s", 0.05}},
      {{"accel_rail_m_s2", 9.0}},
      {{"accel_rail_m_s2", 9.0}, {"accel_plateau_axis_spread_m_s2", 0.1}},
      {{"accel_rail_m_s2", 9.0}, {"accel_plateau_event_spread_m_s2", 0.1}},
      {{"accel_rail_m_s2", 9.0}, {"accel_wrap", 1}},
      {{"accel_rail_m_s2", 9.0}, {"accel_slow_recovery_s", 0.1}, {"accel_slow_recovery_share", 0.2}},
      {{"accel_rail_m_s2", 9.0}, {"clip_after_low_pass", 1}},
      {{"accel_rail_m_s2", 9.0}, {"accel_element_misalignment", 0.02}},
      {{"accel_rail_m_s2", 9.0}, {"accel_element_scale", 0.02}},
      {{"accel_rail_m_s2", 9.0}, {"accel_element_offset_m_s2", 0.1}},
      {{"accel_noise_m_s2_sqrt_hz", 1e-3}},
      {{"accel_bandwidth_hz", 10.0}},
      {{"accel_delay_s", 0.003}},
      {{"accel_bias_turn_on_m_s2", 0.01}},
      {{"accel_bias_in_run_m_s2", 0.01}},
      {{"accel_bias_walk_m_s2_sqrt_s", 0.01}},
      {{"accel_scale_error", 0.01}},
      {{"accel_misalignment_rad", 0.01}},
      {{"accel_quantum_m_s2", 0.05}},
      {{"accel_handover_m_s2", 20.0}, {"accel_precise_noise_m_s2_sqrt_hz", 1e-3}},
      {{"digital_bandwidth_hz", 10.0}},
      {{"time_offset_s", 0.01}},
      {{"time_jitter_s", 0.001}},
      {{"dropout_share", 0.3}},
      {{"start_delay_s", 0.5}},
      {{"glitch_share", 0.1}}};
  for (const auto& option : options) {
    SensorSpec sensor = imu_with();
    for (const auto& [name, value] : option) sensor.values.set(name, value);
    const SimulatedImu on = simulated(motion, sensor);
    sensor.values.set(option.back().first, resolve("imu", {}, imu_parameters()).at(option.back().first));
    const SimulatedImu without = simulated(motion, sensor);
    EXPECT_TRUE(on.record.gyro_rad_s != without.record.gyro_rad_s ||
                on.record.accel_m_s2 != without.record.accel_m_s2 || on.record.time_ns != without.record.time_ns)
        << option.back().first << " changed nothing";
    for (const auto& [name, value] : option) sensor.values.set(name, resolve("imu", {}, imu_parameters()).at(name));
    const SimulatedImu off = simulated(motion, sensor);
    ASSERT_EQ(off.record.gyro_rad_s, exact.record.gyro_rad_s) << option.back().first;
    ASSERT_EQ(off.record.accel_m_s2, exact.record.accel_m_s2) << option.back().first;
    ASSERT_EQ(off.record.time_ns, exact.record.time_ns) << option.back().first;
  }
}

TEST(ImuSimulation, TwinIsTheReadingWhereverNothingClippedOnThatAxis) {
  // x swings through the saturation level while y and z stay below it; noise, bias and axis errors are on
  SensorSpec sensor = imu_with({{"gyro_rail_rad_s", 8.0},
                                {"gyro_noise_rad_s_sqrt_hz", 1e-3},
                                {"gyro_bias_in_run_rad_s", 0.01},
                                {"gyro_misalignment_rad", 0.01},
                                {"gyro_bandwidth_hz", 400.0},
                                {"clip_flags", 1.0}},
                               200.0);
  const SimulatedImu r = simulated(swinging(1.0), sensor);
  int clipped = 0, free = 0;
  for (std::size_t k = 0; k < r.record.gyro_rad_s.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      if ((r.record.clip_flags[k] >> j & 1) != 0) {
        EXPECT_GT(std::abs(r.truth.gyro_unclipped_rad_s[k][j]), std::abs(r.record.gyro_rad_s[k][j]));
        ++clipped;
      } else {
        ASSERT_EQ(r.record.gyro_rad_s[k][j], r.truth.gyro_unclipped_rad_s[k][j]) << k;
        ++free;
      }
    }
  }
  EXPECT_GT(clipped, 30);
  EXPECT_GT(free, 400);
}

TEST(ImuSimulation, WholeWindowsAtTheRailReadExactlyTheRail) {
  // the axis of the rotation itself turns: coning would move a compensated reading away from the plateau
  SensorSpec sensor = imu_with({{"gyro_rail_rad_s", 7.5}});
  Truth truth = turning(0.0, 0.5);
  for (std::size_t k = 0; k < truth.q_WB.size(); ++k) {
    const double t = static_cast<double>(k) * 0.0005;
    truth.q_WB[k] = Eigen::AngleAxisd(12.0 * t, Vector3d::UnitZ()) * Eigen::AngleAxisd(5.0 * t, Vector3d::UnitX());
  }
  const SimulatedImu r = simulated(truth, sensor);
  int whole = 0;
  for (std::size_t k = 0; k < r.record.gyro_rad_s.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      if (std::abs(r.truth.gyro_unclipped_rad_s[k][j]) < 9.0) continue;
      ASSERT_NEAR(std::abs(r.record.gyro_rad_s[k][j]), 7.5, 1e-12);
      ++whole;
    }
  }
  EXPECT_GT(whole, 20);
}

TEST(ImuSimulation, AccelerometerComesLateAgainstTheGyroscope) {
  Truth truth = turning(0.0, 0.2, 0.0);
  for (std::size_t k = 200; k < truth.q_WB.size(); ++k) truth.v_WB_m_s[k].x() = 0.5;  // an impact at 0.1 s
  SensorSpec sensor = imu_with({}, 1000.0);
  const SimulatedImu now = simulated(truth, sensor);
  sensor.values.set("accel_delay_s", 0.004);
  const SimulatedImu late = simulated(truth, sensor);
  EXPECT_NEAR(now.record.accel_m_s2[99].x(), 500.0, 1e-9);
  EXPECT_NEAR(late.record.accel_m_s2[99].x(), 0.0, 1e-9);
  EXPECT_NEAR(late.record.accel_m_s2[103].x(), 500.0, 1e-9);
  EXPECT_EQ(late.record.gyro_rad_s, now.record.gyro_rad_s);
}

TEST(ImuSimulation, LostSamplesAreLostFromTheTruthToo) {
  SensorSpec sensor = imu_with({{"dropout_share", 0.3}});
  const SimulatedImu r = simulated(turning(3.0, 2.0), sensor), all = simulated(turning(3.0, 2.0), imu_with());
  ASSERT_LT(r.record.time_ns.size(), 180u);
  ASSERT_GT(r.record.time_ns.size(), 80u);
  ASSERT_EQ(r.truth.rate_rad_s.size(), r.record.time_ns.size());
  for (std::size_t k = 0; k < r.record.time_ns.size(); ++k) {
    const auto i = static_cast<std::size_t>(r.record.time_ns[k] / 10'000'000 - 1);
    ASSERT_EQ(r.record.accel_m_s2[k], all.record.accel_m_s2[i]);
    ASSERT_EQ(r.truth.specific_force_m_s2[k], all.truth.specific_force_m_s2[i]);
  }
}

TEST(ImuSimulation, HandoverQuietensSlowAxes) {
  SensorSpec sensor = imu_with({{"gyro_noise_rad_s_sqrt_hz", 0.01},
                                {"gyro_handover_rad_s", 1.745},
                                {"gyro_precise_noise_rad_s_sqrt_hz", 0.001}});
  const SimulatedImu r = simulated(turning(5.0, 10.0), sensor);  // fast rotation about z
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < r.record.gyro_rad_s.size(); ++k)
    sum += (r.record.gyro_rad_s[k] - r.truth.rate_rad_s[k]).cwiseAbs2();
  const Vector3d sigma = (sum / static_cast<double>(r.record.gyro_rad_s.size())).cwiseSqrt();
  EXPECT_NEAR(sigma.x(), 0.01, 0.12 * 0.01);  // 5 standard errors of 1000 samples: 11 %
  EXPECT_NEAR(sigma.y(), 0.01, 0.12 * 0.01);
  EXPECT_NEAR(sigma.z(), 0.1, 0.12 * 0.1);
}

TEST(ImuSimulation, RefusesNumbersThatContradictEachOther) {
  const auto complaint = [](Numbers numbers) -> std::string {
    try {
      simulated(turning(1.0, 0.1), imu_with(numbers));
    } catch (const InvalidSituation& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint({{"gyro_wrap", 1}}), HasSubstr("sensors.imu.gyro_wrap needs a saturation level"));
  EXPECT_THAT(complaint({{"accel_slow_recovery_s", 1}}), HasSubstr("accel_slow_recovery_s needs a saturation level"));
  EXPECT_THAT(complaint({{"gyro_rail_rad_s", 3}, {"gyro_plateau_axis_spread_rad_s", 1}}), HasSubstr("below a third"));
  EXPECT_THAT(complaint({{"gyro_rail_rad_s", 3}, {"gyro_wrap", 1}, {"gyro_slow_recovery_s", 1}}),
              HasSubstr("must be 0 with gyro_wrap"));
  EXPECT_THAT(complaint({{"magnetic_source_farthest_m", 0.1}}), HasSubstr("magnetic_source_farthest_m"));
  EXPECT_EQ(complaint({{"gyro_rail_rad_s", 3}, {"gyro_wrap", 1}}), "");
}

TEST(ImuSimulation, TimeOffsetMovesTheStampsAlone) {
  SensorSpec sensor = imu_with();
  const SimulatedImu exact = simulated(turning(3.0, 0.1), sensor);
  sensor.values.set("time_offset_s", -0.004);
  const SimulatedImu late = simulated(turning(3.0, 0.1), sensor);
  EXPECT_EQ(late.record.time_ns.front(), 6'000'000);
  EXPECT_EQ(late.record.gyro_rad_s, exact.record.gyro_rad_s);
}

TEST(ImuSimulation, SeedAndNameDecideTheNoise) {
  SensorSpec sensor = imu_with({{"gyro_noise_rad_s_sqrt_hz", 0.01}});
  const auto same_T = Eigen::Isometry3d::Identity();
  const SimulatedImu a = simulated(turning(3.0, 0.1), sensor, same_T, 1),
                     again = simulated(turning(3.0, 0.1), sensor, same_T, 1);
  const SimulatedImu b = simulated(turning(3.0, 0.1), sensor, same_T, 2);
  sensor.name = "imu_2";
  const SimulatedImu c = simulated(turning(3.0, 0.1), sensor, same_T, 1);
  EXPECT_EQ(a.record.gyro_rad_s, again.record.gyro_rad_s);
  EXPECT_NE(a.record.gyro_rad_s, b.record.gyro_rad_s);
  EXPECT_NE(a.record.gyro_rad_s, c.record.gyro_rad_s);
}

TEST(ImuSimulation, RefusesARateThatDoesNotDivideThePhysics) {
  try {
    simulated(turning(1.0, 0.1), imu_with({}, 300.0));
    FAIL() << "300 Hz was accepted";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), HasSubstr("sensors.imu.output_rate_hz is 300"));
  }
}

}  // namespace
}  // namespace tumble::sim
