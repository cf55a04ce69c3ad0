// SPDX-License-Identifier: BSD-3-Clause
// The test checks time offsets in closed form: the estimates are the truth of another instant.
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/perfect_estimate.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {
namespace {

using testing::perfect_estimate;
using testing::scores;

constexpr double kLate_s = 0.3e-3;

const testing::SyntheticMotion& motion() {
  static const testing::SyntheticMotion motion;
  return motion;
}

const sim::Recording& moving_rig() {
  static const sim::Recording recording = testing::synthetic_rig(motion());
  return recording;
}

/// Returns attitudes and poses of the body as they truly were `late_s` before their stamps.
Estimate late_estimate(double late_s) {
  Estimate estimate = perfect_estimate(moving_rig(), Frame::body);
  for (AttitudeState& attitude : estimate.attitudes)
    attitude.orientation_W = motion().attitude(1e-9 * static_cast<double>(attitude.time_ns) - late_s);
  for (PoseState& pose : estimate.poses) {
    const double time_s = 1e-9 * static_cast<double>(pose.time_ns) - late_s;
    pose.position_W_m = motion().position_m(time_s);
    pose.orientation_W = motion().attitude(time_s);
  }
  return estimate;
}

const std::map<Kind, std::string>& of_attitudes() {
  static const std::map<Kind, std::string> all = {{Kind::attitude, "attitude_time_offset_s"},
                                                  {Kind::position, "pose_time_offset_s"},
                                                  {Kind::slam, "pose_time_offset_s"}};
  return all;
}

// the equality holds to first order in the offset; the second-order term, of the acceleration, cancels from rest to
// rest, and the third is 1e-8 of the offset
TEST(TimeOffset, OfAttitudesAndPosesIsWhatTheyAreLateBy) {
  for (const auto& [kind, name] : of_attitudes()) {
    for (const double late_s : {kLate_s, -kLate_s, 1e-3, 0.0})
      EXPECT_NEAR(scores(kind, late_estimate(late_s), moving_rig()).at(name), late_s, 1e-9) << to_string(kind);
  }
}

TEST(TimeOffset, OfAttitudesIsTheSameInAWorldOfItsOwn) {
  Estimate estimate = late_estimate(kLate_s);
  testing::move_world(Eigen::Translation3d(3.0, -7.0, 2.0) * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()),
                      estimate);
  for (const auto& [kind, name] : of_attitudes())
    EXPECT_NEAR(scores(kind, estimate, moving_rig()).at(name), kLate_s, 1e-9) << to_string(kind);
}

/// Returns the recording with a rate that rises steadily and no saturation: differences of the rate are exact.
sim::Recording steadily_faster(const Vector3d& acceleration_rad_s2) {
  sim::Recording recording = moving_rig();
  sim::ImuTruth& truth = recording.truth.imus.front();
  for (std::size_t k = 0; k < truth.rate_rad_s.size(); ++k) {
    const double time_s = 1e-9 * static_cast<double>(recording.sensors.imus.front().time_ns[k]);
    truth.rate_rad_s[k] = truth.gyro_unclipped_rad_s[k] = time_s * acceleration_rad_s2;
  }
  recording.sensors.imus.front().gyro_rad_s = truth.rate_rad_s;
  return recording;
}

TEST(TimeOffset, OfRatesIsWhatTheyAreLateBy) {
  const Vector3d acceleration_rad_s2(2.0, -1.0, 0.5);
  const sim::Recording recording = steadily_faster(acceleration_rad_s2);
  for (const double late_s : {kLate_s, -kLate_s, 1e-3}) {
    Estimate estimate = perfect_estimate(recording);
    for (AngularRateState& rate : estimate.rates) rate.w_WI_I_rad_s -= late_s * acceleration_rad_s2;
    EXPECT_NEAR(scores(Kind::rate, estimate, recording).at("rate_time_offset_s"), late_s, 1e-13);
  }
}

// in the motion there and back, saturation hides samples: they do not count, whatever the estimate reports for them
TEST(TimeOffset, OfRatesUsesUnclippedSamples) {
  Estimate estimate = perfect_estimate(moving_rig());
  const ClippingTruth truth(moving_rig().sensors, moving_rig().truth);
  std::size_t clipped = 0;
  for (std::size_t k = 0; k < estimate.rates.size(); ++k) {
    const double middle_s = 1e-9 * static_cast<double>(estimate.rates[k].time_ns) - 2.5e-3;
    const Matrix3d R_IB = moving_rig().truth.imus.front().T_BI.linear().transpose();
    estimate.rates[k].w_WI_I_rad_s = R_IB * motion().rate_B_rad_s(middle_s - kLate_s);
    if (truth.clipped_axes(k) == 0) continue;
    ++clipped;
    estimate.rates[k].w_WI_I_rad_s.setZero();
  }
  ASSERT_GT(clipped, 50u);
  // the acceleration is a difference over 10 ms, which is accurate to 1e-4 of an offset
  EXPECT_NEAR(scores(Kind::rate, estimate, moving_rig()).at("rate_time_offset_s"), kLate_s, 1e-3 * kLate_s);
}

// these errors are not delays: across the turn, along it with changing sign, or the same in either direction; each is
// zero at the start of the estimate, where its world is aligned
TEST(TimeOffset, OfAnErrorThatIsNoneOfTimeIsZero) {
  Estimate estimate = late_estimate(0.0);
  const Vector3d across_W = Eigen::Vector3d::UnitZ().cross(motion().axis_W).normalized();
  for (AttitudeState& attitude : estimate.attitudes)
    attitude.orientation_W = so3::exp(0.02 * across_W) * attitude.orientation_W;
  for (std::size_t k = 1; k < estimate.poses.size(); k += 2) {
    PoseState& pose = estimate.poses[k];
    pose.orientation_W = so3::exp((k % 4 == 1 ? 0.02 : -0.02) * motion().axis_W) * pose.orientation_W;
    pose.position_W_m.x() += 0.5;
  }
  for (AngularRateState& rate : estimate.rates) rate.w_WI_I_rad_s += Vector3d(0.3, -0.2, 0.1);
  EXPECT_NEAR(scores(Kind::attitude, estimate, moving_rig()).at("attitude_rmse_rad"), 0.02, 1e-6);
  EXPECT_NEAR(scores(Kind::slam, estimate, moving_rig()).at("ate_rad"), 0.02 / std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(scores(Kind::attitude, estimate, moving_rig()).at("attitude_time_offset_s"), 0.0, 1e-9);
  EXPECT_NEAR(scores(Kind::slam, estimate, moving_rig()).at("pose_time_offset_s"), 0.0, 1e-6);
  EXPECT_NEAR(scores(Kind::rate, estimate, moving_rig()).at("rate_time_offset_s"), 0.0, 1e-6);
}

TEST(TimeOffset, OfABodyThatNeverTurnsIsNone) {
  testing::SyntheticMotion still;
  still.angle_rad = 0.0;
  const sim::Recording recording = testing::synthetic_rig(still);
  for (const auto& [kind, name] : of_attitudes())
    EXPECT_FALSE(scores(kind, perfect_estimate(recording), recording).contains(name)) << to_string(kind);
  EXPECT_FALSE(scores(Kind::rate, perfect_estimate(recording), recording).contains("rate_time_offset_s"));
}

}  // namespace
}  // namespace tumble::scenarios
