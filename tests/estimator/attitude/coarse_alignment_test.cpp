// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/coarse_alignment.hpp"

#include "tests/testing.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

constexpr double kUp_m_s2 = 9.80665;

double tilted_rad(const Eigen::Quaterniond& q) {
  return std::acos(std::clamp((q * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
}

// attitude.md (A19), (A20) in closed form: a velocity that changes by (0.6, -0.4) m/s in 2 s, measured upside down.
TEST(CoarseAlignment, FindsUpFromUpsideDownToWithinTheChangeOfTheVelocity) {
  const Eigen::Quaterniond wrong = so3::exp({3.0, 0.4, 0.0});
  CoarseAlignment alignment;
  alignment.start_alignment(0.25, 4.0);
  for (int node = 0; node < 50; ++node) alignment.add(wrong * Eigen::Vector3d(0.012, -0.008, 0.04 * kUp_m_s2), 0.04);
  alignment.tilt_variance_growth_rad2 += 0.01;
  EXPECT_NEAR(alignment.time_s, 2.0, 1e-9);
  EXPECT_NEAR(tilted_rad(alignment.levelling() * wrong), std::hypot(0.6, 0.4) / (2.0 * kUp_m_s2), 1e-3);
  EXPECT_NEAR(alignment.mean_force_tilt_rad(), std::numbers::pi, 0.2);
  EXPECT_NEAR(alignment.variance_rad2(0.75, kUp_m_s2), 1.0 / std::pow(2.0 * kUp_m_s2, 2) + 0.01, 1e-12);
  EXPECT_NEAR(alignment.tilt_rad2(), 4.01, 1e-12);
  CoarseAlignment none;
  none.start_alignment(0.25, 4.0);
  EXPECT_GT(none.variance_rad2(0.25, kUp_m_s2), 1e6) << "nothing has been read";
}

struct Found {
  double tilt_rad = 0.0, deviation_rad = 0.0, least_deviation_rad = 1e9;  ///< least: within 0.1 s after the gap
};

/// A body that moves by a hand's breadth is struck at the start of a gap of 0.3 s, so that half the change of its rate
/// is wrong by two radians; returns the tilt estimate `after_s` later.
Found behind_a_strike(double after_s) {
  constexpr TimeNs kPeriod_ns = 4'000'000;
  constexpr double kPeriod_s = 4e-3;
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  TimeNs time_ns = 0;
  const auto rate = [](double t_s) -> Eigen::Vector3d {
    const double struck = t_s < 2.01 ? 0.0 : 14.0 * std::exp(-std::max(0.0, t_s - 2.3) / 0.3);
    return {1.5 * std::sin(2.0 * t_s) - struck, 0.8 * std::cos(3.0 * t_s), 0.5};
  };
  Found found;
  for (double t_s = 0.0; t_s < 2.3 + after_s; t_s += kPeriod_s, time_ns += kPeriod_ns) {
    q = (q * so3::exp(kPeriod_s * rate(t_s))).normalized();
    if (t_s > 2.0 && t_s < 2.3) continue;
    const Eigen::Vector3d force(2.0 * std::sin(7.0 * t_s), 1.0 * std::cos(5.0 * t_s), kUp_m_s2);
    EXPECT_TRUE(filter.step({time_ns, rate(t_s), q.conjugate() * force, 0}, state).ok());
    found.deviation_rad = std::sqrt(TumbleAttitude::attitude_covariance_rad2(state)(0, 0));
    if (t_s > 2.301 && t_s < 2.4) found.least_deviation_rad = std::min(found.least_deviation_rad, found.deviation_rad);
  }
  found.tilt_rad = tilted_rad(state.q_WI * q.conjugate());
  return found;
}

TEST(CoarseAlignment, AfterAGapTheFilterReceivesTheVertical) {
  const Found found = behind_a_strike(4.0);
  EXPECT_LT(found.tilt_rad, 0.1);
  EXPECT_LT(found.deviation_rad, 0.1);
  EXPECT_LT(found.tilt_rad, 4.0 * found.deviation_rad);
  EXPECT_GT(found.least_deviation_rad, 0.5) << "nothing has told up by then";
}

TEST(CoarseAlignment, ASecondGapBeforeAlignmentKeepsTheUncertainty) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  const auto step = [&](TimeNs time_ns, double rate_rad_s) {
    ASSERT_TRUE(filter.step({time_ns, {rate_rad_s, 0.0, 0.0}, {0.0, 0.0, kUp_m_s2}, 0}, state).ok());
  };
  TimeNs time_ns = 0;
  for (int k = 0; k < 100; ++k) step(time_ns += 4'000'000, 3.0);
  step(time_ns += 300'000'000, 3.0);
  ASSERT_TRUE(state.alignment.running);
  const double lost = TumbleAttitude::attitude_covariance_rad2(state)(0, 0);
  step(time_ns += 60'000'000, 3.0);  // a single short gap does not require alignment
  EXPECT_TRUE(state.alignment.running);
  EXPECT_GE(TumbleAttitude::attitude_covariance_rad2(state)(0, 0), lost);
}

}  // namespace
}  // namespace tumble
