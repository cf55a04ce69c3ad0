// SPDX-License-Identifier: BSD-3-Clause
// Tests whole turns that a clipped segment may hide: an accelerometer without information while the gyro clips, in
// closed form.
#include "estimator/src/attitude/revolution_hypotheses.hpp"
#include "estimator/attitude/clipped_spin.hpp"
#include "estimator/src/attitude/hand_held_problem.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"

namespace tumble {
namespace {

using testing::ClippedSpin;
using testing::SpinReadings;

constexpr double kHz = SpinReadings::kHz, kPi = std::numbers::pi;

struct SpinEstimate {
  std::vector<AngularRateState> rates;
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

AngularRateState middle(const ClippedSpin& spin, const SpinEstimate& result) {
  return result.rates[static_cast<std::size_t>(kHz * (spin.from_s + 0.5 * spin.lasts_s))];
}

/// With white jerk alone between both sides, an angle theta beyond the uniform spin costs 720 theta^2 / (T^5 q), with
/// the rate theta/T 30 u^2 (1 - u)^2: additional turns have this probability, and fewer turns are below the saturation
/// level.
TEST(RevolutionHypotheses, WhatNothingDeterminesIsCountedInTheCovariance) {
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
  // about each mode: a rate with white jerk, both ends and the angle given
  const double own = q * std::pow(T, 3.0) * (1.0 / 192.0 - 720.0 / (384.0 * 384.0));
  const double spread = std::sqrt(own + second / sum),
               stated = std::sqrt(middle(spin, result).covariance_rad2_s2(0, 0));
  std::printf("closed form: %.2f rad/s\n", spread);
  EXPECT_NEAR(stated, spread, 0.15 * spread);
}

/// The first optimisation of a spin, started at the saturation level, loses a turn and is kept there by the bound;
/// gravity after the segment determines the angle up to whole turns, and the turn with least jerk is selected. Further
/// turns remain possible.
TEST(RevolutionHypotheses, WhatFollowsDecides) {
  ClippedSpin spin;
  spin.more_rad_s = 7.5;
  const SpinEstimate result = estimated_spin(spin);
  const AngularRateState state = middle(spin, result);
  const double error = std::abs(state.w_WI_I_rad_s.x() - spin.rate(spin.from_s + 0.5 * spin.lasts_s));
  EXPECT_GE(result.report.revolutions_corrected, 1);
  EXPECT_EQ(result.report.revolutions_ambiguous, 1);
  EXPECT_LT(error, 1.5);
  EXPECT_LT(error, 3.0 * std::sqrt(state.covariance_rad2_s2(0, 0)));
}

/// Negative control: an accelerometer that measures the spin leaves no segment to test, and its deviation stays small.
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

/// Solved is the problem of such a spin, solved as far as the iterations allow.
struct Solved {
  SpinReadings readings;
  hand_held::NodeData collected;
  hand_held::HandHeldProblem problem;
  HandHeldSmoother::Report report;

  Solved(const ClippedSpin& spin, const HandHeldSmoother::Params& params)
      : readings(spin),
        collected(hand_held::collect_node_data(params, readings.samples, readings.clipped())),
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

/// If a turn is selected but the whole problem cannot be solved from there, the previous solution and its covariance
/// remain, and the covariance includes the more probable turn.
TEST(RevolutionHypotheses, WhereTheWholeCannotBeSolvedAgainTheAnswerBeforeStands) {
  ClippedSpin spin;
  spin.more_rad_s = 7.5;
  Solved solved(spin, smoother_params());
  const std::vector<hand_held::Node> before(solved.problem.nodes().begin(), solved.problem.nodes().end());
  const HandHeldSmoother::Report report = solved.report;
  const auto fails = [](hand_held::HandHeldProblem& problem, HandHeldSmoother::Report& changed) {
    EXPECT_TRUE(problem.solve(changed).ok());
    return Status{ErrorCode::diverged, "iteration in which the smoother for hand-held motion failed", 1.0, 0.0};
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
  const auto middle = static_cast<std::size_t>((spin.from_s + 0.5 * spin.lasts_s) / solved.problem.node_interval_s());
  const double error = before[middle].w_WI_I_rad_s.x() - spin.rate(spin.from_s + 0.5 * spin.lasts_s);
  EXPECT_GT(std::abs(error), 3.0);
  EXPECT_LT(std::abs(error), 3.0 * std::sqrt(solved.problem.covariance(middle)(hand_held::kRate, hand_held::kRate)));
}

/// Further iterations never increase the cost once the hand's power is constant, however bad the start. Full steps
/// increased the cost from 99 to 2841, from 1717 to 8231 and from 261116 to 312785 within these iterations.
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
