// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/motion_summary.hpp"

#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::int64_t kPhysics_ns = 500'000, kImu_ns = 10'000'000;
constexpr std::size_t kStepsPerSample = 20, kSamples = 200;
constexpr double kRail_rad_s = 10.5, kAccelRail_m_s2 = 50.0;

/// Returns two seconds along x: at rest, from 0.5 s to 1.5 s at 2 m/s with a rotation, at rest again; in the air from
/// 1.0 s to 1.25 s; with three impacts, the last two 10 ms apart.
sim::Recording hand_made() {
  sim::Recording recording;
  sim::Truth& truth = recording.truth;
  truth.period_ns = kPhysics_ns;
  double x_m = 0.0;
  for (std::size_t k = 0; k <= kSamples * kStepsPerSample; ++k) {
    const double t_s = 5e-4 * static_cast<double>(k);
    const bool moves = k >= 1000 && k < 3000;
    x_m += moves ? 2.0 * 5e-4 : 0.0;
    truth.p_WB_m.emplace_back(x_m, 0.0, 0.0);
    truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    truth.v_WB_m_s.emplace_back(moves ? 2.0 : 0.0, 0.0, 0.0);
    truth.w_WB_B_rad_s.emplace_back(0.0, moves ? 12.0 : 0.0, 0.0);
    const bool hit = k == 1200 || k == 2600 || k == 2620;
    truth.f_B_m_s2.emplace_back(0.0, 0.0, hit ? 90.0 : 9.8);
    truth.label.push_back(t_s >= 1.0 && t_s < 1.25 ? sim::ContactLabel::air : sim::ContactLabel::grip);
  }
  sim::ImuRecord record;
  sim::ImuTruth imu;
  record.period_ns = kImu_ns;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const std::size_t k = (i + 1) * kStepsPerSample;
    record.time_ns.push_back(static_cast<std::int64_t>(i + 1) * kImu_ns);
    Vector3d rate = truth.w_WB_B_rad_s[k], force(0.0, 0.0, k == 1200 ? 90.0 : 9.8);
    if (k >= 2000 && k < 2400) rate.z() = -16.0;  // |w| = 20
    imu.rate_rad_s.push_back(rate);
    imu.gyro_unclipped_rad_s.push_back(rate);
    imu.accel_unclipped_m_s2.push_back(force);
    record.gyro_rad_s.push_back(rate.cwiseMax(-kRail_rad_s).cwiseMin(kRail_rad_s));
    record.accel_m_s2.push_back(force.cwiseMin(kAccelRail_m_s2));
  }
  recording.sensors.imus.push_back(record);
  truth.imus.push_back(imu);
  return recording;
}

TEST(MotionSummary, OfAMotionMadeByHand) {
  const sim::Recording recording = hand_made();
  const MotionSummary motion = summarise_motion(recording.sensors, recording.truth);
  EXPECT_NEAR(motion.path_m, 2.0, 1.1e-3);  // an additional step of 1 mm at either end
  EXPECT_NEAR(motion.moving_s, 1.0, 1e-9);
  EXPECT_NEAR(motion.rest_at_end_s, 0.5, 1e-3);
  EXPECT_DOUBLE_EQ(motion.peak_rate_rad_s, 20.0);
  EXPECT_DOUBLE_EQ(motion.peak_accel_m_s2, 90.0);
  EXPECT_NEAR(motion.flight_share, 0.25, 1e-3);
  EXPECT_EQ(motion.impacts, 2u);  // the third impact is too close to the second
  EXPECT_EQ(motion.samples, 100u);
  EXPECT_EQ(motion.clipped_samples, 100u);
  EXPECT_EQ(motion.axis_clipped_samples, (std::array<std::size_t, 3>{0, 100, 20}));
  EXPECT_EQ(motion.several_axes_samples, 20u);
  EXPECT_EQ(motion.cross_axis_samples, 0u);
  EXPECT_EQ(motion.accel_clipped_samples, 1u);
}

TEST(MotionSummary, OfARobotThatNeverMovesHoldsNothing) {
  sim::Recording recording = hand_made();
  for (Vector3d& v : recording.truth.v_WB_m_s) v.setZero();
  for (Vector3d& w : recording.truth.w_WB_B_rad_s) w.setZero();
  const MotionSummary motion = summarise_motion(recording.sensors, recording.truth);
  EXPECT_EQ(motion.samples, 0u);
  EXPECT_EQ(motion.clipped_samples, 0u);
  EXPECT_EQ(motion.moving_s, 0.0);
}

TEST(MotionSummary, RefusesATruthThatDoesNotBelong) {
  sim::Recording recording = hand_made();
  recording.truth.label.pop_back();
  EXPECT_THROW(summarise_motion(recording.sensors, recording.truth), BadInput);
  recording = hand_made();
  recording.truth.imus.clear();
  EXPECT_THROW(summarise_motion(recording.sensors, recording.truth), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
