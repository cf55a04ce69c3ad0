// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/attitude/filter_contract.hpp"
#include "scenarios/baselines/attitude/complementary.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/vqf.hpp"

namespace tumble::baselines {
namespace {

using testing::kGravity_m_s2;
using testing::kPeriod_ns;
using testing::tilt;

template <typename Filter>
class Baseline : public ::testing::Test {};
using Filters = ::testing::Types<Complementary, Vqf>;
TYPED_TEST_SUITE(Baseline, Filters);

TYPED_TEST(Baseline, ContractOfEveryFilter) {
  const TypeParam filter({});
  testing::expect_split_runs_equal(filter);
  testing::expect_bad_input_refused(filter);
}

TYPED_TEST(Baseline, RefusesBadParams) {
  typename TypeParam::Params params;
  for (const double gap : {0.0, 1.1e4, std::numeric_limits<double>::quiet_NaN()}) {
    params.gap_max_s = gap;
    EXPECT_THROW(TypeParam{params}, InvalidParams) << gap;
  }
}

TYPED_TEST(Baseline, FollowsAPerfectTurnExactly) {
  const TypeParam filter({});
  const Vector3d rate(0.7, -1.1, 0.4);
  typename TypeParam::State state;
  double error_max_rad = 0.0;
  for (int k = 0; k <= 5000; ++k) {
    const Quaterniond truth = so3::exp(rate * (k * seconds(kPeriod_ns)));
    const Vector3d f_I = truth.conjugate() * Vector3d(0, 0, kGravity_m_s2);
    ASSERT_TRUE(filter.step({k * kPeriod_ns, rate, f_I, 0}, state).ok());
    error_max_rad = std::max(error_max_rad, so3::logarithm(truth.conjugate() * state.q_WI).norm());
  }
  EXPECT_LT(error_max_rad, 1e-10);  // only rounding: measured 1e-12
}

/// Runs a filter at rest with a gyro bias of 0.3 deg/s about a horizontal axis.
template <typename Filter>
typename Filter::State rest_with_bias(const Filter& filter, double bias, double duration_s) {
  typename Filter::State state;
  const int count = static_cast<int>(duration_s / seconds(kPeriod_ns));
  for (int k = 0; k <= count; ++k) {
    EXPECT_TRUE(filter.step({k * kPeriod_ns, {bias, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  }
  return state;
}

TEST(Complementary, TiltDecaysWithItsTimeConstantAtAnyRate) {
  for (const TimeNs period_ns : {TimeNs{1'000'000}, TimeNs{20'000'000}}) {
    const Complementary filter({.tau_s = 0.4});
    Complementary::State state;
    state.q_WI = so3::exp({0.0, 0.5, 0.0});
    state.started = true;
    for (TimeNs t = period_ns; t <= 800'000'000; t += period_ns) {
      ASSERT_TRUE(filter.step({t, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
    }
    EXPECT_NEAR(tilt(state.q_WI), 0.5 * std::exp(-2.0), 1e-12);
  }
}

TEST(Complementary, BiasLeavesATiltOfBiasTimesTau) {
  const Complementary filter({.tau_s = 0.396});
  const double bias = 0.005;
  // in the steady state each step removes what it adds; the discrete sum differs from bias tau by half a step
  const double expected = bias * 0.396;
  EXPECT_NEAR(tilt(rest_with_bias(filter, bias, 10.0).q_WI), expected, bias * seconds(kPeriod_ns));
}

TEST(Complementary, CorrectionTurnsNoHeadingIn) {
  const Complementary filter({.tau_s = 0.1});
  Complementary::State state;
  state.q_WI = so3::exp({0.0, 0.0, 0.4}) * so3::exp({0.3, -1.2, 0.0});
  state.started = true;
  const Quaterniond start = state.q_WI;
  for (int k = 1; k <= 1000; ++k)
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  const Vector3d turned = so3::logarithm(state.q_WI * start.conjugate());
  EXPECT_NEAR(turned.z(), 0.0, 1e-12);
  EXPECT_GT(turned.norm(), 1.0);
}

TEST(Complementary, LevelsItselfFromUpsideDown) {
  const Complementary filter({.tau_s = 0.1});
  Complementary::State state;
  state.started = true;
  for (int k = 1; k <= 1000; ++k)
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, 0}, {0, 0, -kGravity_m_s2}, 0}, state).ok());
  EXPECT_NEAR(tilt(state.q_WI), std::numbers::pi, 1e-9);
}

TEST(Vqf, RestGivesTheBiasMotionDoesNotNeedToStop) {
  const Vqf filter({});
  const Vqf::State rest = rest_with_bias(filter, 0.005, 10.0);
  EXPECT_TRUE(rest.at_rest);
  EXPECT_NEAR(rest.bias_rad_s.x(), 0.005, 2e-5);
  const Vqf motion_only({.rest_bias_estimation = false});
  EXPECT_NEAR(rest_with_bias(motion_only, 0.005, 200.0).bias_rad_s.x(), 0.005, 5e-4);
  const Vqf basic({.rest_bias_estimation = false, .motion_bias_estimation = false});
  EXPECT_EQ(rest_with_bias(basic, 0.005, 10.0).bias_rad_s.norm(), 0.0);
}

TEST(Vqf, OscillatingAccelerationAveragesOut) {
  // the acceleration is 3 m/s^2 at 1 Hz without rotation: the tilt of the basic filter is acceleration / g times the
  // low-pass gain (f_c / f)^2
  const Vqf filter({.rest_bias_estimation = false, .motion_bias_estimation = false});
  Vqf::State state;
  double worst = 0.0;
  for (int k = 0; k <= 10000; ++k) {
    const double t = k * seconds(kPeriod_ns);
    const Vector3d f(3.0 * std::sin(2.0 * std::numbers::pi * t), 0.0, kGravity_m_s2);
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, 0}, f, 0}, state).ok());
    if (t > 30.0) worst = std::max(worst, tilt(state.q_WI));
  }
  const double corner_hz = std::numbers::sqrt2 / (2.0 * std::numbers::pi * 3.0);
  const double gain = 1.0 / std::sqrt(1.0 + std::pow(1.0 / corner_hz, 4));
  EXPECT_NEAR(worst, 3.0 / kGravity_m_s2 * gain, 0.05 * 3.0 / kGravity_m_s2 * gain);
}

/// The test compares the slope form of the low-pass with the published biquad (direct form II transposed) on an
/// irregular signal.
TEST(LowPass, IsTheButterworthBiquad) {
  const double tau = 0.5, dt = 0.004, warp = low_pass_prewarp(tau, dt);
  const double d = warp * warp + std::numbers::sqrt2 * warp + 1.0;
  const double b0 = warp * warp / d, b1 = 2.0 * b0, b2 = b0;
  const double a1 = 2.0 * (warp * warp - 1.0) / d, a2 = (1.0 - std::numbers::sqrt2 * warp + warp * warp) / d;
  const auto input = [](int k) { return std::sin(0.05 * k) + ((k * 7919) % 13 - 6) * 0.1; };
  LowPass<1> filter;
  int k = 0;
  double mean = 0.0;
  for (; filter.averaged_duration_s < tau; ++k) {
    filter.advance(Eigen::Matrix<double, 1, 1>(input(k)), tau, dt, warp);
    mean += (input(k) - mean) / (k + 1);
    ASSERT_NEAR(filter.value[0], mean, 1e-12);
  }
  // both forms start at rest at the mean
  filter.input[0] = mean;
  double s0 = mean * (1.0 - b0), s1 = mean * (b2 - a2);
  for (const int end = k + 1000; k < end; ++k) {
    const double x = input(k), y = b0 * x + s0;
    s0 = b1 * x - a1 * y + s1;
    s1 = b2 * x - a2 * y;
    filter.advance(Eigen::Matrix<double, 1, 1>(x), tau, dt, warp);
    ASSERT_NEAR(filter.value[0], y, 1e-10) << k;  // measured 2e-13
  }
}

TEST(LowPass, ChangingPeriodLeavesASteadyValueAlone) {
  LowPass<1> filter;
  for (int k = 0; k < 2000; ++k) {
    const double dt = k % 3 == 0 ? 0.002 : 0.009;
    filter.advance(Eigen::Matrix<double, 1, 1>(5.0), 0.5, dt, low_pass_prewarp(0.5, dt));
    ASSERT_NEAR(filter.value[0], 5.0, 1e-12);
  }
}

}  // namespace
}  // namespace tumble::baselines
