// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/tumble_attitude.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/attitude/filter_contract.hpp"
#include "tumble/attitude/vqf.hpp"

namespace tumble {
namespace {

using testing::kGravity_m_s2;
using testing::kPeriod_ns;

double tilt(const Eigen::Quaterniond& q_WI) {
  const Eigen::Vector3d up = q_WI.conjugate() * Eigen::Vector3d::UnitZ();
  return std::atan2(std::hypot(up.x(), up.y()), up.z());
}

TEST(TumbleAttitude, ContractOfEveryFilter) {
  const TumbleAttitude filter({});
  testing::expect_split_runs_equal(filter);
  testing::expect_bad_input_refused(filter);
  testing::expect_sign_of_q_is_free(filter);
}

TEST(TumbleAttitude, RefusesBadParams) {
  EXPECT_THROW(TumbleAttitude({.gravity_m_s2 = 0.0}), InvalidParams);
  EXPECT_THROW(TumbleAttitude({.gyro_noise_rad_sqrts = -1.0}), InvalidParams);
  EXPECT_THROW(TumbleAttitude({.node_s = 2.0}), InvalidParams);
  EXPECT_THROW(TumbleAttitude({.velocity_m_sqrts = std::numeric_limits<double>::quiet_NaN()}), InvalidParams);
}

TEST(TumbleAttitude, AtRestTheBiasIsFoundAndTheAttitudeHeld) {
  const TumbleAttitude filter({});
  const Eigen::Vector3d bias(0.005, -0.004, 0.006);
  TumbleAttitude::State state, after_2s;
  for (int k = 0; k <= 15000; ++k) {
    // a gyro that chatters by 1 deg/s about its bias, an accelerometer by 0.02 m/s^2
    const double noise = k % 2 == 0 ? 1.0 : -1.0;
    const ImuSample sample{
        k * kPeriod_ns, bias + Eigen::Vector3d::Constant(0.017 * noise), {0.02 * noise, 0.0, kGravity_m_s2}, 0};
    ASSERT_TRUE(filter.step(sample, state).ok());
    if (k == 500) after_2s = state;
  }
  EXPECT_TRUE(after_2s.at_rest);
  EXPECT_NEAR((state.bias_rad_s - bias).norm(), 0.0, 1e-4);  // measured 3e-6
  // a minute with a vertical bias of 0.34 deg/s is 20 deg of heading for a gyro alone
  EXPECT_NEAR(so3::log(after_2s.q_WI.conjugate() * state.q_WI).z(), 0.0, 1e-9);
  EXPECT_NEAR(tilt(state.q_WI), 0.0, 1e-4);
}

TEST(TumbleAttitude, SlowTurnAfterTheBiasIsKnownIsNotRest) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  const double turn = 0.05;  // 2.9 deg/s, smooth
  for (int k = 0; k <= 5000; ++k) {
    const double rate = k > 1250 ? turn : 0.0;
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, rate}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  }
  EXPECT_FALSE(state.at_rest);
  // 15 s; what passes before the turn is seen is part of a sample's low-pass: measured 3 mrad
  EXPECT_NEAR(so3::log(state.q_WI).z(), turn * 15.0, 0.01);
}

// A sphere that has rolled goes on turning about its contact, slower than a detector by itself would tell: attitude.md
// (A11a)
TEST(TumbleAttitude, ACreepingTurnAfterTheBiasIsKnownIsNotRest) {
  constexpr double kCreep = 0.02;  // rad/s
  const auto after_creeping = [&](const TumbleAttitude::Params& params) {
    const TumbleAttitude filter(params);
    TumbleAttitude::State state;
    for (int k = 0; k <= 5000; ++k) {
      const double rate = k <= 1250 ? 0.0 : k <= 1750 ? 6.0 : kCreep;
      EXPECT_TRUE(filter.step({k * kPeriod_ns, {0, 0, rate}, {0, 0, kGravity_m_s2}, 0}, state).ok());
    }
    return state;
  };
  const TumbleAttitude::State state = after_creeping({});
  EXPECT_FALSE(state.at_rest);
  EXPECT_NEAR(state.bias_rad_s.z(), 0.0, 1e-3);
  // negative control: what the detector says without asking how well the bias is known
  const TumbleAttitude::State believed = after_creeping({.rest_rate_sigmas = 1e6});
  EXPECT_TRUE(believed.at_rest);
  EXPECT_GT(believed.bias_rad_s.z(), 0.5 * kCreep);
}

TEST(TumbleAttitude, AnOscillationTiltsItLessThanVqf) {
  const TumbleAttitude ours({});
  const Vqf other({});
  TumbleAttitude::State a;
  Vqf::State b;
  double worst_a = 0.0, worst_b = 0.0;
  for (int k = 0; k <= 15000; ++k) {
    const double t = k * seconds(kPeriod_ns);
    // velocity amplitude 0.48 m/s at 1 Hz: 3 m/s^2, an apparent tilt of 17 deg
    const ImuSample sample{
        k * kPeriod_ns, {0, 0, 0}, {3.0 * std::sin(2.0 * std::numbers::pi * t), 0.0, kGravity_m_s2}, 0};
    ASSERT_TRUE(ours.step(sample, a).ok());
    ASSERT_TRUE(other.step(sample, b).ok());
    if (t < 30.0) continue;
    worst_a = std::max(worst_a, tilt(a.q_WI));
    worst_b = std::max(worst_b, tilt(b.q_WI));
  }
  EXPECT_GT(worst_b, 1e-3) << "the input tilts nothing";
  EXPECT_LT(worst_a, 0.5 * worst_b);
}

TEST(TumbleAttitude, CovarianceStaysAProperOneAndShrinks) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  for (const ImuSample& sample : testing::wobble(20000)) {
    ASSERT_TRUE(filter.step(sample, state).ok());
    if (sample.time_ns % 1'000'000'000 != 0) continue;
    const auto eigenvalues = Eigen::SelfAdjointEigenSolver<TumbleAttitude::Covariance>(state.covariance).eigenvalues();
    ASSERT_GT(eigenvalues.minCoeff(), 0.0) << seconds(sample.time_ns);
  }
  EXPECT_LT(std::sqrt(state.covariance(0, 0)), 0.02);
}

}  // namespace
}  // namespace tumble
