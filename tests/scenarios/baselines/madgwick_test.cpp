// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/madgwick.hpp"

#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/strapdown.hpp"

namespace tumble::baselines {
namespace {

using testing::kGravity_m_s2;
using testing::kPeriod_ns;
using testing::tilt;

/// This is a second implementation of the published step: q is (w, x, y, z), the rate is a 4x4 matrix, the objective
/// uses the rotation matrix R(q), and its gradient comes from central differences instead of a published Jacobian.
Eigen::Vector4d reference_step(const Eigen::Vector4d& q, const Vector3d& w, const Vector3d& f, double gain, double dt) {
  const Vector3d up = f.normalized();
  const auto objective = [&up](const Eigen::Vector4d& p) {
    // the third row of R(q) has the form of the report (eq 25); published forms differ where |q| is not 1
    const Vector3d row(2 * (p[1] * p[3] - p[0] * p[2]), 2 * (p[0] * p[1] + p[2] * p[3]),
                       2 * (0.5 - p[1] * p[1] - p[2] * p[2]));
    return 0.5 * (row - up).squaredNorm();
  };
  Eigen::Vector4d gradient;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d d = 1e-5 * Eigen::Vector4d::Unit(i);
    gradient[i] = (objective(q + d) - objective(q - d)) / 2e-5;
  }
  Eigen::Matrix4d rate;
  rate << 0, -w.x(), -w.y(), -w.z(), w.x(), 0, w.z(), -w.y(), w.y(), -w.z(), 0, w.x(), w.z(), w.y(), -w.x(), 0;
  return (q + dt * (0.5 * rate * q - gain * gradient.normalized())).normalized();
}

TEST(Madgwick, AgreesWithAMatrixFormStepByStep) {
  const double gain = 0.1;
  const Madgwick filter({.gain_rad_s = gain});
  Madgwick::State state;
  double worst = 0.0;
  for (const ImuSample& sample : testing::wobble(2000)) {
    const Madgwick::State before = state;
    ASSERT_TRUE(filter.step(sample, state).ok());
    if (!before.started) continue;
    const Quaterniond& p = before.q_WI;
    const Eigen::Vector4d expected = reference_step({p.w(), p.x(), p.y(), p.z()}, sample.angular_velocity_rad_s,
                                                    sample.specific_force_m_s2, gain, seconds(kPeriod_ns));
    const Eigen::Vector4d got(state.q_WI.w(), state.q_WI.x(), state.q_WI.y(), state.q_WI.z());
    worst = std::max(worst, (got - expected).cwiseAbs().maxCoeff());
  }
  // central differences with 1e-5 leave an error of about 1e-10 of the gradient, more where the gradient is small,
  // times gain dt = 4e-4; measured 8.6e-12
  EXPECT_LT(worst, 1e-10);
  EXPECT_GT(worst, 0.0) << "nothing was compared";
}

/// The test computes one step of the filter by hand, with the Jacobian of the report.
TEST(Madgwick, OneStepByHand) {
  // with q = identity and f along +y: F = (0, -1, 1), s = J^T F = (w 0, x -2, y 0, z 0) -> unit (0, -1, 0, 0)
  const Madgwick filter({.gain_rad_s = 0.5});
  Madgwick::State state;
  state.started = true;
  ASSERT_TRUE(filter.step({100'000'000, {0, 0, 0}, {0, 9.8, 0}, 0}, state).ok());
  const double length = std::hypot(1.0, 0.05);
  EXPECT_NEAR(state.q_WI.w(), 1.0 / length, 1e-15);
  EXPECT_NEAR(state.q_WI.x(), 0.05 / length, 1e-15);
  EXPECT_EQ(state.q_WI.y(), 0.0);
  EXPECT_EQ(state.q_WI.z(), 0.0);
}

TEST(Madgwick, CorrectsSmallTiltAtTwiceTheGainAndLargeTiltMoreSlowly) {
  // the published gradient has a component along q, which the normalisation removes: the speed is 2 gain / sqrt(1 + 4
  // tan^2(tilt / 2))
  const double gain = 0.05;
  const Madgwick filter({.gain_rad_s = gain});
  for (const double angle : {0.01, 0.1, 0.6, 1.5, 2.9}) {
    Madgwick::State state;
    state.q_WI = so3::exp({angle, 0.0, 0.0});
    state.started = true;
    ASSERT_TRUE(filter.step({1'000'000, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
    const double speed = (angle - tilt(state.q_WI)) / 1e-3;
    // the explicit step has a relative error of the order of gain dt = 5e-5
    EXPECT_NEAR(speed, 2.0 * gain / std::sqrt(1.0 + 4.0 * std::pow(std::tan(0.5 * angle), 2)), 1e-4 * gain) << angle;
  }
}

TEST(Madgwick, ChattersByTwiceGainTimesStepOnPerfectData) {
  const double gain = 0.2, step = 2.0 * gain * seconds(kPeriod_ns);
  const Madgwick filter({.gain_rad_s = gain});
  Madgwick::State state;
  state.q_WI = so3::exp({0.3 * step, 0.0, 0.0});
  state.started = true;
  double previous = 0.0;
  for (int k = 1; k <= 50; ++k) {
    const Quaterniond before = state.q_WI;
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
    // the filter makes steps of fixed size to and fro about the truth: the sign alternates and the size never shrinks
    const double moved = so3::logarithm(before.conjugate() * state.q_WI).x();
    EXPECT_NEAR(std::abs(moved), step, 1e-6 * step);
    if (k > 1) {
      EXPECT_LT(moved * previous, 0.0) << "step " << k;
    }
    previous = moved;
  }
}

TEST(Madgwick, UpsideDownIsASaddleThatTheGyroLeaves) {
  const Madgwick filter({.gain_rad_s = 0.5});
  const ImuSample sample{kPeriod_ns, {0, 0, 0}, {0, 0, -kGravity_m_s2}, 0};
  Madgwick::State state;
  state.started = true;
  ASSERT_TRUE(filter.step(sample, state).ok());
  EXPECT_EQ(state.q_WI.coeffs(), Eigen::Vector4d(0, 0, 0, 1)) << "gyro alone where the gradient vanishes";
  state.q_WI = so3::exp({1e-4, 0.0, 0.0});
  state.last_time_ns = 0;
  for (int k = 1; k <= 1000; ++k)
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, 0}, {0, 0, -kGravity_m_s2}, 0}, state).ok());
  // 4 s at 1 rad/s suffice for half a turn; the remaining error is the oscillation of 4 mrad
  EXPECT_NEAR(tilt(state.q_WI), std::numbers::pi, 0.0041);
}

TEST(Madgwick, StandingGyroStillCorrects) {
  // the reference implementations return q unchanged when the rate is exactly zero; that is an error of theirs and not
  // a property of the filter
  const Madgwick filter({.gain_rad_s = 0.1});
  Madgwick::State state;
  state.q_WI = so3::exp({0.1, 0.0, 0.0});
  state.started = true;
  ASSERT_TRUE(filter.step({kPeriod_ns, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  EXPECT_LT(tilt(state.q_WI), 0.1 - 0.5 * 2.0 * 0.1 * seconds(kPeriod_ns));
}

TEST(Madgwick, FreeFallIntegratesTheGyroAlone) {
  const Madgwick filter({});
  const Madgwick without({.gain_rad_s = 0.0});
  Madgwick::State state, expected;
  for (const ImuSample& sample : testing::wobble(10)) {
    ImuSample falling = sample;
    if (state.started) falling.specific_force_m_s2.setZero();
    ASSERT_TRUE(filter.step(falling, state).ok());
    ASSERT_TRUE(without.step(sample, expected).ok());
  }
  EXPECT_EQ(state.q_WI.coeffs(), expected.q_WI.coeffs());
}

TEST(Madgwick, ContractOfEveryFilter) {
  const Madgwick filter({});
  testing::expect_split_runs_equal(filter);
  testing::expect_bad_input_refused(filter);
  testing::expect_sign_of_q_is_free(filter);
}

TEST(Madgwick, RefusesBadParams) {
  EXPECT_THROW(Madgwick({.gain_rad_s = -0.1}), InvalidParams);
  EXPECT_THROW(Madgwick({.gain_rad_s = 10.1}), InvalidParams);
  EXPECT_THROW(Madgwick({.gain_rad_s = std::numeric_limits<double>::quiet_NaN()}), InvalidParams);
  EXPECT_THROW(Madgwick({.gap_max_s = 0.0}), InvalidParams);
}

}  // namespace
}  // namespace tumble::baselines
