// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/rolling_odometry.hpp"

#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {
namespace {

constexpr double kRadius_m = 0.145;
constexpr TimeNs kSample_ns = 4'000'000;
const Quaterniond kLevel = Eigen::Quaterniond::Identity();

TEST(RollingOdometry, SignsOfTheRollingLaw) {
  const RollingOdometry odometry({.radius_m = kRadius_m});
  RollingOdometry::State state;
  ASSERT_TRUE(odometry.step(0, {0, 1, 0}, kLevel, state).ok());
  EXPECT_NEAR((state.v_WG_m_s - Vector3d(0.145, 0, 0)).norm(), 0.0, 1e-17);
  ASSERT_TRUE(odometry.step(kSample_ns, {1, 0, 0}, kLevel, state).ok());
  EXPECT_NEAR((state.v_WG_m_s - Vector3d(0, -0.145, 0)).norm(), 0.0, 1e-17);
  ASSERT_TRUE(odometry.step(2 * kSample_ns, {0, 0, 5}, kLevel, state).ok());
  EXPECT_EQ(state.v_WG_m_s.norm(), 0.0) << "spinning about the normal does not move the centre";
}

TEST(RollingOdometry, StraightRollInTurningBodyAxes) {
  // the body turns with the roll about a world axis in the horizontal plane: two metres, 13.8 rad
  const Vector3d w_W(0.6, 2.0, 0.0);
  const Quaterniond start = so3::exp({0.3, -1.1, 0.7});
  const RollingOdometry odometry({.radius_m = kRadius_m});
  RollingOdometry::State state;
  for (int k = 0; k <= 1000; ++k) {
    const Quaterniond q_WI = so3::exp(w_W * (k * seconds(kSample_ns))) * start;
    ASSERT_TRUE(odometry.step(k * kSample_ns, q_WI.conjugate() * w_W, q_WI, state).ok());
  }
  const Vector3d expected = kRadius_m * 4.0 * Vector3d(2.0, -0.6, 0.0);
  EXPECT_NEAR((state.p_WG_m - expected).norm(), 0.0, 1e-13);  // measured 4e-15
}

TEST(RollingOdometry, CircleClosesOnItself) {
  // the heading turns at 1 rad/s and the speed is 0.3 m/s, so the path is a circle of 0.3 m; the samples divide the
  // whole turn evenly, so the trapezoid rule closes exactly
  constexpr int kSteps = 1571;
  const double dt = 2.0 * std::numbers::pi / kSteps, speed = 0.3;
  const TimeNs period_ns = std::llround(dt * 1e9);
  const RollingOdometry odometry({.radius_m = kRadius_m});
  RollingOdometry::State state;
  double widest = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double heading = 2.0 * std::numbers::pi * k / kSteps;
    const Vector3d w_W(-speed / kRadius_m * std::sin(heading), speed / kRadius_m * std::cos(heading), 1.0);
    ASSERT_TRUE(odometry.step(k * period_ns, w_W, kLevel, state).ok());
    widest = std::max(widest, state.p_WG_m.norm());
  }
  EXPECT_NEAR(state.p_WG_m.norm(), 0.0, 1e-12);
  EXPECT_NEAR(widest, 2.0 * 0.3, 1e-5);  // diameter; the trapezoid rule is short by dt^2 / 12 = 1.3e-6 of it
}

TEST(RollingOdometry, TrapezoidIsExactForLinearRateAndUnevenSteps) {
  const RollingOdometry odometry({.radius_m = kRadius_m});
  RollingOdometry::State state;
  const double slope = 3.0;
  TimeNs t = 0;
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(odometry.step(t, {0, slope * seconds(t), 0}, kLevel, state).ok());
    if (k < 199) t += 1'000'000 + (k * 7919) % 9'000'000;
  }
  EXPECT_NEAR(state.p_WG_m.x(), kRadius_m * 0.5 * slope * seconds(t) * seconds(t), 1e-13);
  EXPECT_EQ(state.p_WG_m.z(), 0.0);
}

TEST(RollingOdometry, SlopeMovesAlongThePlane) {
  // slope of 0.3 rad, upwards towards +x
  const Vector3d normal = Vector3d(-std::sin(0.3), 0.0, std::cos(0.3));
  const RollingOdometry odometry({.radius_m = kRadius_m, .normal_W = normal});
  RollingOdometry::State state;
  for (int k = 0; k <= 250; ++k) ASSERT_TRUE(odometry.step(k * kSample_ns, {0, 2, 0}, kLevel, state).ok());
  const double length = kRadius_m * 2.0;
  EXPECT_NEAR((state.p_WG_m - length * Vector3d(std::cos(0.3), 0, std::sin(0.3))).norm(), 0.0, 1e-14);
}

TEST(RollingOdometry, SplitRunsAndSignOfQ) {
  const RollingOdometry odometry({});
  const auto feed = [&odometry](int from, int to, double sign, RollingOdometry::State state) {
    for (int k = from; k < to; ++k) {
      Quaterniond q = so3::exp({0.01 * k, 0.003 * k, -0.002 * k});
      q.coeffs() *= sign;
      EXPECT_TRUE(odometry.step(k * kSample_ns, {std::sin(0.1 * k), 1.0, 0.2}, q, state).ok());
    }
    return state;
  };
  const RollingOdometry::State whole = feed(0, 500, 1.0, {});
  EXPECT_GT(whole.p_WG_m.norm(), 0.01);
  for (const int cut : {1, 2, 250, 499}) EXPECT_TRUE(whole == feed(cut, 500, 1.0, feed(0, cut, 1.0, {}))) << cut;
  EXPECT_TRUE(whole == feed(0, 500, -1.0, {}));
}

TEST(RollingOdometry, RefusesBadInputAndKeepsItsState) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const RollingOdometry odometry({});
  RollingOdometry::State state;
  ASSERT_TRUE(odometry.step(0, {0, 1, 0}, kLevel, state).ok());
  ASSERT_TRUE(odometry.step(kSample_ns, {0, 1, 0}, kLevel, state).ok());
  const RollingOdometry::State before = state;
  const auto refused = [&](TimeNs t, const Vector3d& w, const Quaterniond& q) {
    const ErrorCode error_code = odometry.step(t, w, q, state).error_code;
    EXPECT_TRUE(state == before) << to_string(error_code);
    return error_code;
  };
  EXPECT_EQ(refused(2 * kSample_ns, {kNan, 0, 0}, kLevel), ErrorCode::non_finite);
  EXPECT_EQ(refused(2 * kSample_ns, {1e300, 1e300, 0}, kLevel), ErrorCode::out_of_range);
  EXPECT_EQ(refused(2 * kSample_ns, {0, 1, 0}, Quaterniond(kNan, 0, 0, 0)), ErrorCode::non_finite);
  EXPECT_EQ(refused(2 * kSample_ns, {0, 1, 0}, Quaterniond(0, 0, 0, 0)), ErrorCode::out_of_range);
  EXPECT_EQ(refused(kSample_ns, {0, 1, 0}, kLevel), ErrorCode::time_order);
  EXPECT_EQ(refused(std::numeric_limits<TimeNs>::min(), {0, 1, 0}, kLevel), ErrorCode::time_order);
  EXPECT_EQ(refused(kSample_ns + 1'000'000'001, {0, 1, 0}, kLevel), ErrorCode::gap);
  EXPECT_EQ(odometry.step(2 * kSample_ns, {0, 1, 0}, kLevel, state).error_code, ErrorCode::none);
}

TEST(RollingOdometry, RefusesBadParams) {
  EXPECT_THROW(RollingOdometry({.radius_m = 0.0}), InvalidParams);
  EXPECT_THROW(RollingOdometry({.radius_m = 11.0}), InvalidParams);
  EXPECT_THROW(RollingOdometry({.normal_W = {0, 0, 2}}), InvalidParams);
  EXPECT_THROW(RollingOdometry({.gap_max_s = -1.0}), InvalidParams);
}

}  // namespace
}  // namespace tumble::baselines
