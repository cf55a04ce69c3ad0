// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/strapdown.hpp"

#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::kGravity_m_s2;

Eigen::Vector3d up_in_body(const Eigen::Quaterniond& q_WI) {
  return q_WI.conjugate() * Eigen::Vector3d::UnitZ();
}

double yaw(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

TEST(Level, PointsUpAlongTheForceWithYawZero) {
  for (const Eigen::Vector3d& f :
       {Eigen::Vector3d(0, 0, 9.8), Eigen::Vector3d(1, -2, 9), Eigen::Vector3d(-3, 4, -8), Eigen::Vector3d(0, -9.8, 0),
        Eigen::Vector3d(0, 0, -9.8), Eigen::Vector3d(5, 5, 1e-9)}) {
    Eigen::Quaterniond q;
    ASSERT_TRUE(inclination_from_force(f, q).ok());
    EXPECT_LT((up_in_body(q) - f.normalized()).norm(), 1e-15) << f.transpose();  // measured 3.3e-16
    EXPECT_NEAR(yaw(q), 0.0, 1e-15) << f.transpose();
  }
}

TEST(Level, NoseStraightUpOrDownIsFinite) {
  for (const double x : {9.8, -9.8}) {
    Eigen::Quaterniond q;
    ASSERT_TRUE(inclination_from_force({x, 0.0, 0.0}, q).ok());
    EXPECT_LT((up_in_body(q) - Eigen::Vector3d(x / 9.8, 0, 0)).norm(), 1e-15);
  }
}

TEST(Level, RefusesNoForceAndNaN) {
  Eigen::Quaterniond q(0.5, 0.5, 0.5, 0.5);
  EXPECT_EQ(inclination_from_force(Eigen::Vector3d(0, 9e-7, 0), q).error_code, ErrorCode::degenerate);
  EXPECT_EQ(inclination_from_force(Eigen::Vector3d(0, std::numeric_limits<double>::quiet_NaN(), 9.8), q).error_code,
            ErrorCode::non_finite);
  EXPECT_EQ(inclination_from_force(Eigen::Vector3d(std::numeric_limits<double>::infinity(), 0, 9.8), q).error_code,
            ErrorCode::non_finite);
  EXPECT_EQ(q.w(), 0.5) << "untouched on trouble";
}

TEST(Strapdown, ConstantRateIsExactForAnyStep) {
  const Strapdown filter({});
  const Eigen::Vector3d rate(3.0, -2.0, 7.0);
  for (const TimeNs period_ns : {TimeNs{1'000'000}, TimeNs{100'000'000}}) {  // 0.79 rad per step in the second
    Strapdown::State state;
    for (TimeNs t = 0; t <= 1'000'000'000; t += period_ns) {
      ASSERT_TRUE(filter.step({t, rate, {0, 0, kGravity_m_s2}, 0}, state).ok());
    }
    // measured 1.6e-14 rad over 1000 steps
    EXPECT_NEAR(so3::logarithm(so3::exp(rate * 1.0).conjugate() * state.q_WI).norm(), 0.0, 1e-13);
    EXPECT_NEAR(state.q_WI.norm(), 1.0, 1e-15);
  }
}

/// Returns the mean body rate over [t - h, t] of the coning motion q(t) = Exp(a (cos Wt, sin Wt, 0)).
Eigen::Vector3d coning_rate(double t, double h, double half_cone, double coning_rad_s) {
  const double from = coning_rad_s * (t - h), to = coning_rad_s * t;
  return {std::sin(half_cone) * (std::cos(to) - std::cos(from)) / h,
          std::sin(half_cone) * (std::sin(to) - std::sin(from)) / h, coning_rad_s * (std::cos(half_cone) - 1.0)};
}

TEST(Strapdown, ConingDriftsByWhatOneRatePerSampleCannotKnow) {
  constexpr double kHalfCone = 0.05;
  constexpr double kConing_rad_s = 2.0 * std::numbers::pi * 5.0;
  constexpr int kSteps = 2000;  // whole revolutions of the cone: 2000 * 4 ms * 5 Hz = 40
  const double h = seconds(testing::kPeriod_ns);
  const Strapdown filter({});
  Strapdown::State state;
  state.q_WI = so3::exp({kHalfCone, 0.0, 0.0});
  state.started = true;
  for (int k = 1; k <= kSteps; ++k) {
    const Eigen::Vector3d w = coning_rate(k * h, h, kHalfCone, kConing_rad_s);
    ASSERT_TRUE(filter.step({k * testing::kPeriod_ns, w, {0, 0, kGravity_m_s2}, 0}, state).ok());
  }
  const Eigen::Vector3d error = so3::logarithm(state.q_WI * so3::exp({kHalfCone, 0.0, 0.0}).conjugate());
  // half the integral of (angle so far) x (rate) over one sample, about the cone's axis, which the mean rate omits
  const double per_step = 0.5 * std::pow(std::sin(kHalfCone), 2) * (kConing_rad_s * h - std::sin(kConing_rad_s * h));
  // 1 %: the second-order drift is along the body's z axis, within 0.05 rad of the cone's axis; measured 0.1 %
  EXPECT_NEAR(error.z(), -kSteps * per_step, 0.01 * kSteps * per_step);
  EXPECT_GT(kSteps * per_step, 1e-4) << "a drift too small to test anything";
}

TEST(Strapdown, ContractOfEveryFilter) {
  const Strapdown filter({});
  testing::expect_split_runs_equal(filter);
  testing::expect_bad_input_refused(filter);
  testing::expect_sign_of_q_is_free(filter);
}

TEST(Strapdown, RefusesBadParams) {
  for (const double gap : {0.0, -1.0, 1.1e4, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(Strapdown({.gap_max_s = gap}), InvalidParams) << gap;
  }
}

}  // namespace
}  // namespace tumble
