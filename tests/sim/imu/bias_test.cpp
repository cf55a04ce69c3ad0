// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/bias.hpp"

#include "sim/imu/allan.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Returns the mean Allan curve of the three axes of a bias alone.
std::vector<AllanPoint> curve_of(const Bias::Params& params, double period_s, double duration_s, std::uint64_t seed) {
  Bias bias(params, period_s, Stream(seed, "test"));
  std::vector<std::vector<double>> axes(3);
  for (int k = 0; k < std::lround(duration_s / period_s); ++k) {
    const Vector3d now = bias.next();
    for (int j = 0; j < 3; ++j) axes[static_cast<std::size_t>(j)].push_back(now[j]);
  }
  std::vector<std::vector<AllanPoint>> curves;
  for (const auto& axis : axes) curves.push_back(allan_deviation(axis, period_s));
  return mean_deviation(curves);
}

TEST(BiasStage, OffIsExactlyZero) {
  Bias bias({}, 0.0005, Stream(1, "test"));
  for (int k = 0; k < 10; ++k) ASSERT_EQ(bias.next(), Vector3d::Zero());
}

TEST(BiasStage, TurnOnIsDrawnOnceWithItsSigma) {
  double sum = 0.0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    Bias bias({.turn_on = 0.2}, 0.0005, Stream(i, "test"));
    const Vector3d first = bias.next();
    ASSERT_EQ(bias.next(), first);
    sum += first.squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum / (3 * kDraws)), 0.2, 0.032 * 0.2);  // 5 standard errors, false alarm 6e-7
}

TEST(BiasStage, WalkGrowsWithTheRootOfTimeWhateverThePeriod) {
  for (const double period_s : {0.0005, 0.01}) {
    double sum = 0.0;
    constexpr int kRuns = 500;
    for (int run = 0; run < kRuns; ++run) {
      Bias bias({.walk_sqrt_s = 0.1}, period_s, Stream(run, "test"));
      Vector3d last = Vector3d::Zero();
      for (int k = 0; k <= std::lround(0.25 / period_s); ++k) last = bias.next();
      sum += last.squaredNorm();
    }
    const double n = 3.0 * kRuns;
    EXPECT_NEAR(sum / n, 0.25 * 0.01, 5.0 * std::sqrt(2.0 / n) * 0.25 * 0.01)
        << "period " << period_s;  // false alarm 6e-7
  }
}

TEST(BiasStage, InRunIsBoundedAndStationary) {
  constexpr int kRuns = 1500;
  double start = 0.0, later = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Bias bias({.in_run = 1.0, .in_run_s = 1.0}, 0.05, Stream(run, "test"));
    start += bias.next().squaredNorm();
    for (int k = 0; k < 100; ++k) bias.next();  // five times the longest correlation time
    later += bias.next().squaredNorm();
  }
  const double n = 3.0 * kRuns, variance = 2.578 * 2.578;  // four times ln 10 / (2 ln 2)
  EXPECT_NEAR(start / n, variance, 5.0 * std::sqrt(2.0 / n) * variance);
  EXPECT_NEAR(later / n, variance, 5.0 * std::sqrt(2.0 / n) * variance);  // false alarm 6e-7 each
}

TEST(BiasStage, InRunHasAFlatFloorAtItsFigure) {
  const Bias::Params params{.in_run = 3.0, .in_run_s = 1000.0};
  for (double tau_s = 5.0; tau_s <= 500.0; tau_s *= 1.3)
    EXPECT_NEAR(Bias::in_run_deviation(params, tau_s), 3.0, 0.05 * 3.0) << tau_s << " s";
  EXPECT_LT(Bias::in_run_deviation(params, 1e5), 0.6);  // bounded, whereas a random walk would continue to grow
}

TEST(BiasStage, InRunFollowsItsClosedForm) {
  const Bias::Params params{.in_run = 0.3, .in_run_s = 100.0};
  const auto curve = curve_of(params, 0.02, 2000.0, 3);
  ASSERT_GT(curve.size(), 15u);
  for (const AllanPoint& point : curve) {
    // the process is sampled, not averaged: the variance is 1 + 1/(2 m^2) times as large
    if (point.cluster < 10) continue;
    const double expected = Bias::in_run_deviation(params, point.tau_s);
    const AllanInterval interval = confidence_interval(point, AllanNoise::flicker, 3.5);
    EXPECT_LT(interval.low, expected) << point.tau_s << " s";
    EXPECT_GT(interval.high, expected) << point.tau_s << " s";
  }
}

TEST(BiasStage, OneProcessAloneHasNoFloor) {
  // negative control of the test above: a single process with the same peak is outside the interval on both sides
  EXPECT_LT(gauss_markov_deviation(3.0 / 0.617, 100.0, 5.0), 0.7 * 3.0);
}

TEST(BiasStage, SameStreamSameBiasWhereverItIsCut) {
  const Bias::Params params{0.1, 0.2, 10.0, 0.05};
  Bias whole(params, 0.01, Stream(7, "test"));
  for (int k = 0; k < 50; ++k) whole.next();
  Bias rest = whole;  // the object is the state
  for (int k = 0; k < 50; ++k) ASSERT_EQ(whole.next(), rest.next());
}

}  // namespace
}  // namespace tumble::sim
