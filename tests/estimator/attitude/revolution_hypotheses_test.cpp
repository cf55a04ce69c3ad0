// SPDX-License-Identifier: BSD-3-Clause
// Tests hypotheses about whole revolutions in a clipped segment: the accelerometer has no information while the gyro
// clips. Closed-form motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "estimator/attitude/clipped_spin.hpp"
#include "estimator/src/attitude/hand_held_problem.hpp"
#include "estimator/src/attitude/revolution_hypotheses.hpp"
#include "tumble/attitude/hand_held_smoother.hpp"

namespace tumble {
namespace {

using testing::ClippedSpin;
using testing::SpinReadings;

constexpr double kHz = SpinReadings::kHz, kPi = std::numbers::pi;

struct SpinEstimate {
  std::vector<RateState> rates;
  HandHeldSmoother::Report report;
};

HandHeldSmoother::Params smoother_params() {
  HandHeldSmoother::Params out;
  out.hand_sigma_m_s2 = 1.0;
  out.gyro_bias_sigma_rad_s = 1e-3;
  out.expert.jerk_inflation = 1.0;
  out.expert.iterations_max = 100;  // a filter with wrong forces is a poor start
  return out;
}

SpinEstimate estimated_spin(const ClippedSpin& spin) {
  const SpinReadings readings(spin);
  SpinEstimate out;
  std::vector<AttitudeState> attitudes;
  const Status status = HandHeldSmoother(smoother_params())
                            .estimate(readings.samples, readings.clipped(), out.rates, attitudes, out.report);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(out.rates.size(), readings.samples.size());
  const auto middle = static_cast<std::size_t>(kHz * (spin.from_s + 0.5 * spin.lasts_s));
  std::printf("asked %d, taken %d, open %d; in the middle %.2f of %.2f, deviation %.2f rad/s\n",
              out.report.revolutions_tested, out.report.revolutions_corrected, out.report.revolutions_ambiguous,
              out.rates[middle].w_WI_I_rad_s.x(), spin.rate(spin.from_s + 0.5 * spin.lasts_s),
              std::sqrt(out.rates[middle].covariance_rad2_s2(0, 0)));
  return out;
}

RateState middle(const ClippedSpin& spin, const SpinEstimate& result) {
  return result.rates[static_cast<std::size_t>(kHz * (spin.from_s + 0.5 * spin.lasts_s))];
}

/// If only white jerk connects both sides, an angle theta above that of the constant rate costs 720 theta^2 / (T^5 q).
/// Its rate is theta/T 30 u^2 (1 - u)^2. More revolutions have the corresponding likelihood; fewer would be below the
/// saturation limit.
TEST(RevolutionHypotheses, WhatNothingTellsIsCountedInTheCovariance) {
  ClippedSpin spin;
  spin.more_rad_s = 4.0;
  const SpinEstimate result = estimated_spin(spin);
  EXPECT_EQ(result.report.revolutions_tested, 1);
  EXPECT_EQ(result.report.revolutions_corrected, 0);
  EXPECT_EQ(result.report.revolutions_ambiguous, 1);
  const double q = std::pow(smoother_params().jerk_rad_s3_sqrts, 2.0), T = spin.lasts_s + 1.0 / kHz;
  const double theta = 0.5 * spin.more_rad_s * spin.lasts_s;
  double sum = 0.0, second = 0.0;
  for (int n = 0; n < 3; ++n) {
    const double angle = theta + 2.0 * kPi * n;
    const double share = std::exp(-0.5 * 720.0 * angle * angle / (std::pow(T, 5.0) * q));
    sum += share;
    second += share * std::pow(2.0 * kPi * n / T * 30.0 / 16.0, 2.0);
  }
  // about each mode: a rate with white jerk, with given ends and angle
  const double own = q * std::pow(T, 3.0) * (1.0 / 192.0 - 720.0 / (384.0 * 384.0));
  const double spread = std::sqrt(own + second / sum),
               stated = std::sqrt(middle(spin, result).covariance_rad2_s2(0, 0));
  std::printf("closed form: %.2f rad/s\n", spread);
  EXPECT_NEAR(stated, spread, 0.15 * spread);
}

/// A spin for which the first optimisation, started at the saturation limit, loses a revolution and remains at the
/// bound. Gravity after the segment determines the angle modulo whole revolutions. The solution with the smallest jerk
/// is selected; more revolutions remain possible.
TEST(RevolutionHypotheses, WhatFollowsDecides) {
  ClippedSpin spin;
  spin.more_rad_s = 7.5;
  const SpinEstimate result = estimated_spin(spin);
  const RateState state = middle(spin, result);
  const double error = std::abs(state.w_WI_I_rad_s.x() - spin.rate(spin.from_s + 0.5 * spin.lasts_s));
  EXPECT_GE(result.report.revolutions_corrected, 1);
  EXPECT_EQ(result.report.revolutions_ambiguous, 1);
  EXPECT_LT(error, 1.5);
  EXPECT_LT(error, 3.0 * std::sqrt(state.covariance_rad2_s2(0, 0)));
}

/// Negative control: if the accelerometer measures the spin, the rate is not ambiguous, and its deviation is small.
TEST(RevolutionHypotheses, ASegmentThatIsKnownIsNotAsked) {
  ClippedSpin spin;
  spin.more_rad_s = 4.0;
  spin.lasts_s = 0.6;
  spin.blind = false;
  const SpinEstimate result = estimated_spin(spin);
  EXPECT_EQ(result.report.revolutions_tested, 0);
  EXPECT_EQ(result.report.revolutions_corrected, 0);
  EXPECT_EQ(result.report.revolutions_ambiguous, 0);
  EXPECT_LT(std::sqrt(middle(spin, result).covariance_rad2_s2(0, 0)), 2.0);
}

/// The problem of such a spin, solved up to the iteration limit.
struct Solved {
  SpinReadings readings;
  hand_held::NodeData collected;
  hand_held::Problem problem;
  HandHeldSmoother::Report report;

  Solved(const ClippedSpin& spin, const HandHeldSmoother::Params& params)
      : readings(spin),
        collected(hand_held::collect(params, readings.samples, readings.clipped())),
        problem(params, Eigen::Matrix3d::Identity(), collected, started(params)) {
    EXPECT_TRUE(problem.solve(report).ok());
    EXPECT_TRUE(problem.covariances(report).ok());
  }

 private:
  std::vector<hand_held::Node> started(const HandHeldSmoother::Params& params) const {
    std::vector<hand_held::Node> nodes;
    EXPECT_TRUE(hand_held::start_nodes(params, Eigen::Matrix3d::Identity(), collected, nodes).ok());
    return nodes;
  }
};

/// A revolution is added, but the optimisation from there does not converge. The previous result and its values remain,
/// and its covariance includes the likelier revolution.
TEST(RevolutionHypotheses, WhereTheWholeCannotBeSolvedAgainTheAnswerBeforeStands) {
  ClippedSpin spin;
  spin.more_rad_s = 7.5;
  Solved solved(spin, smoother_params());
  const std::vector<hand_held::Node> before(solved.problem.nodes().begin(), solved.problem.nodes().end());
  const HandHeldSmoother::Report report = solved.report;
  const auto fails = [](hand_held::Problem& problem, HandHeldSmoother::Report& changed) {
    EXPECT_TRUE(problem.solve(changed).ok());
    return Status{ErrorCode::diverged, "iteration of the smoother for hand-held motion", 1.0, 0.0};
  };
  hand_held::test_revolutions(solved.problem, solved.report, fails);
  EXPECT_EQ(solved.report.revolutions_tested, 1);
  EXPECT_EQ(solved.report.revolutions_corrected, 0);
  EXPECT_EQ(solved.report.revolutions_failed, 1);
  EXPECT_EQ(solved.report.revolutions_ambiguous, 1);
  EXPECT_EQ(solved.report.cost, report.cost);
  EXPECT_EQ(solved.report.constants.lever_arm_m, report.constants.lever_arm_m);
  ASSERT_EQ(solved.problem.nodes().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(solved.problem.nodes()[i].w_WI_I_rad_s, before[i].w_WI_I_rad_s) << i;
  }
  const auto middle = static_cast<std::size_t>((spin.from_s + 0.5 * spin.lasts_s) / solved.problem.node_s());
  const double error = before[middle].w_WI_I_rad_s.x() - spin.rate(spin.from_s + 0.5 * spin.lasts_s);
  EXPECT_GT(std::abs(error), 3.0);
  EXPECT_LT(std::abs(error), 3.0 * std::sqrt(solved.problem.covariance(middle)(hand_held::kRate, hand_held::kRate)));
}

/// While the power of the hand is constant, more iterations never increase the cost, even from a bad start. Full steps
/// increase it from 99 to 2841, from 1717 to 8231 and from 261116 to 312785 here.
TEST(HandHeldDescent, DoesNotClimb) {
  const ClippedSpin spins[] = {{.more_rad_s = 4.0, .duration_s = 7.5, .blind = false},
                               {.more_rad_s = 15.0, .duration_s = 7.5},
                               {.more_rad_s = 15.0, .lasts_s = 0.5, .duration_s = 7.5}};
  for (const ClippedSpin& spin : spins) {
    HandHeldSmoother::Params some = smoother_params();
    double least = 1e300;
    for (int count = 10; count <= 15; ++count) {
      some.expert.iterations_max = count;
      const double cost = Solved(spin, some).report.cost;
      EXPECT_LT(cost, least + 0.3) << spin.more_rad_s << " " << spin.lasts_s << " " << count;
      least = std::min(least, cost);
    }
  }
}

}  // namespace
}  // namespace tumble
