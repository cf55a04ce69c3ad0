// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/score.hpp"

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/perfect_estimate.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

ScoringInput input() {
  return {&rig().sensors, &rig().truth, nullptr};
}

std::size_t count_poses(const ScoredEstimate& scored) {
  return scored.estimate().poses.size();
}

std::size_t count_rates(const ScoredEstimate& scored) {
  return scored.estimate().rates.size();
}

std::size_t count_both(const ScoredEstimate& scored) {
  return scored.once(count_poses) + scored.once(count_rates);
}

std::size_t refuse(const ScoredEstimate&) {
  throw BadInput("nothing to make it from");
}

TEST(ScoredEstimate, MakesAThingOnce) {
  const Estimate estimate = testing::perfect_estimate(rig());
  const ScoredEstimate scored(estimate, input());
  const std::size_t& poses = scored.once(count_poses);
  EXPECT_EQ(poses, estimate.poses.size());
  EXPECT_EQ(scored.once(count_both), estimate.poses.size() + estimate.rates.size());
  EXPECT_EQ(&scored.once(count_poses), &poses) << "the same object, also after others have been made";
  EXPECT_EQ(&paired_track(scored), &paired_track(scored));
  EXPECT_NE(&scored.once(count_rates), &poses) << "of the same type, made by another function";
}

TEST(ScoredEstimate, KeepsNothingForAnotherEstimate) {
  const Estimate whole = testing::perfect_estimate(rig()), empty;
  EXPECT_EQ(ScoredEstimate(whole, input()).once(count_poses), whole.poses.size());
  EXPECT_EQ(ScoredEstimate(empty, input()).once(count_poses), 0u);
}

TEST(ScoredEstimate, AFailureIsReportedToEachCaller) {
  const Estimate estimate;
  const ScoredEstimate scored(estimate, input());
  EXPECT_THROW(scored.once(refuse), BadInput);
  EXPECT_THROW(scored.once(refuse), BadInput);
}

TEST(ScoredEstimate, ScoresAreThoseOfAnEstimateThatNobodyAskedBefore) {
  const Estimate estimate = testing::perfect_estimate(rig());
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    const ScoredEstimate scored(estimate, input());
    EXPECT_EQ(verdict(kind, scored), verdict(kind, {estimate, input()}));
    const std::vector<Score> after = score(kind, scored), fresh = score(kind, {estimate, input()});
    ASSERT_EQ(after.size(), fresh.size());
    for (std::size_t k = 0; k < fresh.size(); ++k) {
      EXPECT_EQ(after[k].metric, fresh[k].metric);
      EXPECT_EQ(after[k].value, fresh[k].value) << fresh[k].metric;
    }
  }
}

TEST(PairedRates, StandBesideTheRatesAndLeaveOutWhatTheTruthDoesNotKnow) {
  Estimate estimate = testing::perfect_estimate(rig());
  const Vector3d error(0.1, -0.2, 0.3);
  for (AngularRateState& rate : estimate.rates) rate.w_WI_I_rad_s += error;
  estimate.rates.back().time_ns = rig().sensors.imus.front().time_ns.back() + 1;
  const ScoredEstimate scored(estimate, input());
  const std::vector<PairedRate>& pairs = paired_rates(scored);
  ASSERT_EQ(pairs.size(), estimate.rates.size());
  for (std::size_t k = 0; k + 1 < pairs.size(); ++k) {
    ASSERT_TRUE(pairs[k].truth.has_value());
    EXPECT_EQ(pairs[k].estimate, &estimate.rates[k]);
    EXPECT_EQ(pairs[k].sample, k);
    EXPECT_EQ(pairs[k].clipped_axes(), clipping_truth(scored).clipped_axes(k));
    EXPECT_NEAR((pairs[k].error_rad_s() - error).norm(), 0.0, 1e-12);
  }
  EXPECT_FALSE(pairs.back().truth.has_value());
  EXPECT_EQ(pairs.back().clipped_axes(), 0);
}

}  // namespace
}  // namespace tumble::scenarios
