// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/slip_observer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/rolling/rolling_truth.hpp"
#include "scenarios/baselines/rolling/rolling_odometry.hpp"
#include "tests/scenarios/baselines/rolled.hpp"

namespace tumble::baselines {
namespace {

using testing::l_shape;
using testing::no_slip;
using testing::RollingTruth;

constexpr TimeNs k125Hz_ns = 8'000'000;

/// Returns a smooth pulse of the contact velocity along x, which rises and falls over a fifth of its length.
std::function<Eigen::Vector3d(double)> pulse(double start_s, double length_s, double speed_m_s) {
  return [=](double t) -> Eigen::Vector3d {
    const double edge = 0.2 * length_s;
    const auto rise = [edge](double s) {
      const double x = std::clamp(s / edge, 0.0, 1.0);
      return x * x * (3.0 - 2.0 * x);
    };
    return {speed_m_s * rise(t - start_s) * rise(start_s + length_s - t), 0.0, 0.0};
  };
}

RollingTruth truth_with(const std::function<Eigen::Vector3d(double)>& contact) {
  return testing::roll({.velocity_m_s = l_shape, .contact_velocity_m_s = contact, .period_ns = k125Hz_ns});
}

double end_error(const RollingTruth& truth) {
  const SlipObserver::State end = rolled(SlipObserver({}), truth);
  return (end.p_WG_m - truth.p_WG_m.back().head<2>()).norm();
}

double rolling_end_error(const RollingTruth& truth) {
  const RollingOdometry odometry({});
  RollingOdometry::State state;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    EXPECT_TRUE(
        odometry.step(truth.samples[k].time_ns, truth.samples[k].angular_velocity_rad_s, truth.q_WI[k], state).ok());
  }
  return (state.p_WG_m - truth.p_WG_m.back()).norm();
}

TEST(SlipObserver, CleanRollOpensNoEvent) {
  const RollingTruth truth = truth_with(no_slip);
  const SlipObserver observer({});
  SlipObserver::State state;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    ASSERT_TRUE(observer.step(truth.samples[k], truth.q_WI[k], state).ok());
    ASSERT_FALSE(state.open) << k;
  }
  EXPECT_NEAR((state.p_WG_m - truth.p_WG_m.back().head<2>()).norm(), 0.0, 0.003);
}

TEST(SlipObserver, IdealSlipAndSlideAreFound) {
  for (const double speed : {-0.6, 0.3}) {  // rotates too fast; rotates too slowly
    const RollingTruth truth = truth_with(pulse(2.8, 0.8, speed));
    const double rolling = rolling_end_error(truth);
    EXPECT_GT(rolling, 0.15) << speed;
    EXPECT_LT(end_error(truth), 0.1 * rolling) << speed;
  }
}

TEST(SlipObserver, EventThatNeverEndsIsUndone) {
  const RollingTruth truth = truth_with(pulse(2.8, 5.0, 0.4));
  const SlipObserver observer({});
  SlipObserver::State state;
  bool opened = false, ignored = false;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    ASSERT_TRUE(observer.step(truth.samples[k], truth.q_WI[k], state).ok());
    opened = opened || state.open;
    ignored = ignored || state.ignoring;
    if (state.open) {
      ASSERT_LE(state.event_s, 2.0 + 0.008);
    }
  }
  EXPECT_TRUE(opened);
  EXPECT_TRUE(ignored);
}

TEST(SlipObserver, SplitRunsEqual) {
  const RollingTruth truth = truth_with(pulse(2.8, 0.8, -0.6));
  const SlipObserver observer({});
  const std::size_t count = truth.samples.size();
  const SlipObserver::State whole = rolled(observer, truth, 0, count);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{8}, std::size_t{370}, count - 1}) {
    const SlipObserver::State carried = rolled(observer, truth, 0, cut);
    EXPECT_FALSE(carried == whole);
    EXPECT_TRUE(rolled(observer, truth, cut, count, carried) == whole) << cut;
  }
}

TEST(SlipObserver, RefusesBadInputAndParams) {
  const RollingTruth truth = truth_with(no_slip);
  const SlipObserver observer({});
  const SlipObserver::State before = rolled(observer, truth, 0, 300);
  SlipObserver::State state = before;
  ImuSample bad = truth.samples[300];
  bad.specific_force_m_s2.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(observer.step(bad, truth.q_WI[300], state).error_code, ErrorCode::non_finite);
  EXPECT_EQ(observer.step(truth.samples[299], truth.q_WI[299], state).error_code, ErrorCode::time_order);
  EXPECT_EQ(observer.step(truth.samples[600], truth.q_WI[600], state).error_code, ErrorCode::gap);
  EXPECT_EQ(observer.step(truth.samples[300], Eigen::Quaterniond(2, 0, 0, 0), state).error_code,
            ErrorCode::out_of_range);
  EXPECT_TRUE(state == before);
  EXPECT_THROW(SlipObserver({.radius_m = -1.0}), InvalidParams);
  EXPECT_THROW(SlipObserver({.timeout_s = 0.0}), InvalidParams);
}

}  // namespace
}  // namespace tumble::baselines
