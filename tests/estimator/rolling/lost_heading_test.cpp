// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/rolling/lagged_params.hpp"
#include "estimator/rolling/rolling_truth.hpp"
#include "estimator/src/rolling/rolling_node.hpp"
#include "tests/testing.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

// a bounce without readings: the heading after it is unknown, and contact does not determine it
namespace tumble {
namespace {

using testing::kLeverArm;

constexpr double kBounce_s = 5.0, kBounceLasts_s = 0.02, kTurn_rad = 1.7;

/// 0.8 m/s along x, from 5 s on sideways, to rest.
Eigen::Vector3d bouncing(double t) {
  const auto ramp = [](double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); };
  const double speed = 0.8 * (ramp((t - 2.0) / 1.0) - ramp((t - 6.5) / 1.0));
  const double towards = kTurn_rad * ramp((t - kBounce_s) / kBounceLasts_s);
  return speed * Eigen::Vector3d(std::cos(towards), std::sin(towards), 0.0);
}

struct End {
  double error_m = 0.0, deviations = 0.0;
};

/// Returns the end of a run that lost `gap_s` of data, `before_s` of it before the bounce.
End end_of(double gap_s, double before_s, double lag_s) {
  const testing::RollingTruth truth = testing::roll({.velocity_m_s = bouncing,
                                                     .contact_velocity_m_s = testing::no_slip,
                                                     .lever_arm_m = kLeverArm,
                                                     .q_start = so3::exp({0.1, -0.2, 0.0})});
  const RollingSmoother smoother(testing::lagged_params(lag_s));
  const auto state = std::make_unique<RollingSmoother::State>();
  std::vector<RollingEstimate> out;
  for (const ImuSample& sample : truth.samples) {
    const double since_s = seconds(sample.time_ns) - (kBounce_s - before_s);
    if (since_s > 0.0 && since_s < gap_s) continue;
    const Status status = smoother.step(sample, *state, out);
    EXPECT_TRUE(status.ok()) << status.message();
  }
  smoother.finish(*state, out);
  const Eigen::Vector2d error = (out.back().sphere_centre_W_m - truth.p_WG_m.back()).head<2>();
  const Eigen::Matrix2d P = out.back().covariance.topLeftCorner<2, 2>();
  return {error.norm(), std::sqrt(error.dot(P.llt().solve(error)))};
}

// without the correction, heading and velocity were estimated as if both had continued: up to 7.1 deviations
TEST(LostHeading, ABounceInAGapIncreasesTheCovariance) {
  double worst_m = 0.0;
  for (const double lag_s : {RollingSmoother::kWholeRecordingLag, 1.0}) {
    for (const double before_s : {0.03, 0.1, 0.15, 0.25}) {
      const End end = end_of(0.3, before_s, lag_s);
      EXPECT_LT(end.deviations, 3.0) << before_s << " " << lag_s << " " << end.error_m;
      worst_m = std::max(worst_m, end.error_m);
    }
  }
  EXPECT_GT(worst_m, 0.1);  // the test needs a difficult case
  EXPECT_LT(end_of(0.0, 0.0, RollingSmoother::kWholeRecordingLag).error_m, 0.03);
}

TEST(LostHeading, TheContactDoesNotDetermineARotationOfTheWholeRun) {
  RollingParams params = testing::lagged_params(0.0).filter;
  RollingNominalState nominal;
  nominal.q_WI = so3::exp({0.3, -0.7, 1.1});
  nominal.v_WI_m_s = {0.7, -0.3, 0.02};
  nominal.floor_slope = {0.1, -0.05};
  RollingNodeIntegrals sums;
  sums.node_interval_s = 0.02;
  rolling::Contact c = rolling::contact(params, nominal, {2.0, -4.0, 1.0}, sums);
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  rolling::Vector turn = rolling::Vector::Zero();
  turn[rolling::kAttitude + 2] = 1.0;
  turn.segment<2>(rolling::kVelocity) = turned(nominal.v_WI_m_s);
  turn.segment<2>(rolling::kSlope) = turned(nominal.floor_slope);
  const Eigen::Vector3d with_all = c.measurement_jacobian * turn,
                        of_turn = Eigen::Vector3d::UnitZ().cross(c.contact_velocity_W_m_s);
  EXPECT_GT(of_turn.norm(), 0.1);
  EXPECT_LT((with_all - of_turn).norm(), 1e-9);
  rolling::remove_heading_component(c);
  EXPECT_LT((c.measurement_jacobian * turn).norm(), 1e-9);
}

TEST(LostHeading, ErrorsMoveWithTheNominal) {
  rolling::Vector x = rolling::Vector::LinSpaced(rolling::kStates, -0.5, 0.7), error = x.reverse();
  const rolling::Vector turned = rolling::heading_component(x);
  rolling::Covariance T = rolling::Covariance::Identity(), P = error * error.transpose();
  T.col(rolling::kAttitude + 2) += turned;
  const rolling::Covariance moved = T * P * T.transpose();
  rolling::remove_heading_covariance(turned, P);
  EXPECT_LT((P - moved).norm(), 1e-12);
  rolling::Vector one = error;
  rolling::remove_heading_error(turned, one);
  EXPECT_LT((one - T * error).norm(), 1e-12);
  EXPECT_GT((one - error).norm(), 0.1);
}

}  // namespace
}  // namespace tumble
