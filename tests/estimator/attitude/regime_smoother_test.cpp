// SPDX-License-Identifier: BSD-3-Clause
// Tests rates of a whole recording for any motion type: a twirl in closed form uses the hand-held smoother, and a spin
// in free flight does not.
#include "tumble/attitude/detail/regime_smoother.hpp"

#include "estimator/attitude/hand_held_motion.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using testing::HandHeldMotion;
using testing::HandHeldRecording;

constexpr double kGyroRail_rad_s = 7.0;

MotionRegimeSmoother::Params params_of(const HandHeldMotion& motion) {
  MotionRegimeSmoother::Params params;
  params.rate.model.nominal.lever_arm_m = motion.lever_arm_m;
  return params;
}

/// Returns the median error where the gyro clips.
double clipped_error(const HandHeldRecording& recording, const std::vector<AngularRateState>& rates) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (recording.signs[k].gyro[0] == 0) continue;
    errors.push_back((rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm());
  }
  EXPECT_GT(errors.size(), 50u);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

TEST(MotionRegimeSmoother, ATwirlIsTheHands) {
  const HandHeldMotion motion;
  const HandHeldRecording recording = record(motion, 100.0, 10.0, kGyroRail_rad_s);
  std::vector<AngularRateState> alone, joined;
  AngularRateReport of_flight;
  MotionRegimeSmoother::Report report;
  ASSERT_TRUE(AngularRateSmoother(params_of(motion).rate).estimate(recording.samples, alone, of_flight).ok());
  ASSERT_TRUE(MotionRegimeSmoother(params_of(motion)).estimate(recording.samples, joined, report).ok());
  ASSERT_EQ(joined.size(), recording.samples.size());
  EXPECT_TRUE(report.regimes_estimated && report.hand_held_smoother_ran);
  EXPECT_GT(report.hand_held_probability_max, 0.9);
  EXPECT_NEAR(report.probabilities.flight + report.probabilities.contact + report.probabilities.hand_held, 1.0, 1e-9);
  EXPECT_LT(clipped_error(recording, joined), 0.5 * clipped_error(recording, alone));
}

// Each force is logged four times; assigned to each sample's own time, the hidden segments would look like flight, with
// errors of 11 rad/s.
TEST(MotionRegimeSmoother, ARepeatedForceIsComparedAtItsOwnTime) {
  HandHeldMotion motion;
  motion.spin_rad = 4.0;
  motion.spin_hz = motion.hand_hz = 1.0;
  motion.hand_m = 0.15;
  HandHeldRecording recording = record(motion, 100.0, 10.0, kGyroRail_rad_s);
  constexpr std::size_t kPeriod = 4;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    const double taken_s = 0.01 * static_cast<double>(k - k % kPeriod);
    recording.samples[k].specific_force_m_s2 = motion.specific_force(taken_s);
  }
  std::vector<AngularRateState> joined;
  MotionRegimeSmoother::Report report;
  ASSERT_TRUE(MotionRegimeSmoother(params_of(motion)).estimate(recording.samples, joined, report).ok());
  EXPECT_GT(report.hand_held_probability_max, 0.7);
  EXPECT_LT(clipped_error(recording, joined), 1.0);
}

// The motion reverses ten times with few readings in between, so it is one segment; an unknown motion type in the first
// tenth of a second must not affect the rest, which would be wrong by 10 rad/s.
TEST(MotionRegimeSmoother, AHandAtTheStartSaysNothingAboutTheRest) {
  HandHeldMotion motion;
  motion.spin_rad = 4.0;
  motion.spin_hz = motion.hand_hz = 1.0;
  const HandHeldRecording recording = record(motion, 100.0, 10.0, kGyroRail_rad_s);
  std::vector<AngularRateState> alone, joined;
  AngularRateReport of_flight;
  MotionRegimeSmoother::Report report;
  ASSERT_TRUE(AngularRateSmoother(params_of(motion).rate).estimate(recording.samples, alone, of_flight).ok());
  ASSERT_TRUE(MotionRegimeSmoother(params_of(motion)).estimate(recording.samples, joined, report).ok());
  EXPECT_GT(clipped_error(recording, alone), 5.0);
  EXPECT_LT(clipped_error(recording, joined), 1.0);
}

TEST(MotionRegimeSmoother, ASpinInFlightIsNot) {
  const HandHeldMotion motion;
  HandHeldRecording recording = record(motion, 100.0, 10.0, kGyroRail_rad_s);
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {  // the same rotation without a hand
    const double t = 0.01 * (static_cast<double>(k) + 0.5);
    const Eigen::Vector3d w = motion.rate(t);
    recording.samples[k].specific_force_m_s2 =
        motion.angular_acceleration(t).cross(motion.lever_arm_m) + w.cross(w.cross(motion.lever_arm_m));
  }
  std::vector<AngularRateState> alone, joined;
  AngularRateReport of_flight;
  MotionRegimeSmoother::Report report;
  ASSERT_TRUE(AngularRateSmoother(params_of(motion).rate).estimate(recording.samples, alone, of_flight).ok());
  ASSERT_TRUE(MotionRegimeSmoother(params_of(motion)).estimate(recording.samples, joined, report).ok());
  EXPECT_TRUE(report.regimes_estimated);
  EXPECT_FALSE(report.hand_held_smoother_ran);
  ASSERT_EQ(joined.size(), alone.size());
  for (std::size_t k = 0; k < joined.size(); ++k) {
    ASSERT_EQ(joined[k].w_WI_I_rad_s, alone[k].w_WI_I_rad_s);
    ASSERT_EQ(joined[k].covariance_rad2_s2, alone[k].covariance_rad2_s2);
  }
}

TEST(MotionRegimeSmoother, RefusesWhatItsPartsRefuse) {
  MotionRegimeSmoother::Params params = params_of({});
  params.hand_held_probability_min = 1.5;
  EXPECT_THROW(MotionRegimeSmoother{params}, InvalidParams);
  params = params_of({});
  params.hand_held.expert.node_s = 0.0;
  EXPECT_THROW(MotionRegimeSmoother{params}, InvalidParams);
  std::vector<AngularRateState> rates(3);
  MotionRegimeSmoother::Report report;
  EXPECT_EQ(MotionRegimeSmoother(params_of({})).estimate({}, rates, report).error_code, ErrorCode::empty);
  EXPECT_TRUE(rates.empty());
}

}  // namespace
}  // namespace tumble
