// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/paths.hpp"

#include "tests/testing.hpp"

namespace tumble::tools {
namespace {

using Eigen::AngleAxisd;

constexpr std::int64_t kPeriodNs = 1000000;

/// Returns a motion that rests for 0.5 s, then spirals upwards for 1 s while turning about its axis, then rests for 0.5
/// s.
sim::Truth spiral() {
  sim::Truth truth;
  truth.period_ns = kPeriodNs;
  const Vector3d axis = Vector3d(1, 2, 3).normalized();
  for (int k = 0; k <= 2000; ++k) {
    const double t = std::clamp(k * 1e-3 - 0.5, 0.0, 1.0);
    const bool moves = k > 500 && k <= 1500;
    truth.p_WB_m.emplace_back(2.0 * std::cos(3.0 * t), 2.0 * std::sin(3.0 * t), 0.5 * t);
    truth.q_WB.emplace_back(AngleAxisd(2.0 * t, axis));
    truth.v_WB_m_s.push_back(moves ? Vector3d(-6.0 * std::sin(3.0 * t), 6.0 * std::cos(3.0 * t), 0.5)
                                   : Vector3d::Zero());
    truth.w_WB_B_rad_s.push_back(moves ? Vector3d(2.0 * axis) : Vector3d::Zero());
  }
  sim::ImuTruth imu;
  imu.T_BI.translation() = Vector3d(0.1, -0.2, 0.3);
  imu.T_BI.linear() = AngleAxisd(0.7, Vector3d::UnitY()).toRotationMatrix();
  truth.imus.push_back(imu);
  return truth;
}

sim::Sensors sensors_of(const sim::Truth& truth) {
  sim::Sensors sensors;
  sim::ImuRecord imu;
  imu.T_BI = truth.imus.front().T_BI;
  sensors.imus.push_back(imu);
  return sensors;
}

/// Returns the true IMU poses in another world frame, at another position and heading.
scenarios::Estimate perfect_estimate(const sim::Truth& truth, scenarios::Frame frame) {
  Isometry3d T_VW = Isometry3d::Identity();
  T_VW.linear() = AngleAxisd(1.2, Vector3d::UnitZ()).toRotationMatrix();
  T_VW.translation() = Vector3d(10, -4, 2);
  Isometry3d T_BA = Isometry3d::Identity();
  if (frame == scenarios::Frame::imu) T_BA = truth.imus.front().T_BI;
  if (frame == scenarios::Frame::centre) T_BA.translation() = truth.p_BG_m;
  scenarios::Estimate estimate;
  estimate.frame = frame;
  for (std::size_t k = 0; k < truth.p_WB_m.size(); k += 10) {
    Isometry3d T_WB = Isometry3d::Identity();
    T_WB.linear() = truth.q_WB[k].toRotationMatrix();
    T_WB.translation() = truth.p_WB_m[k];
    const Isometry3d T_VA = T_VW * T_WB * T_BA;
    PoseState pose;
    pose.time_ns = static_cast<std::int64_t>(k) * kPeriodNs;
    pose.position_W_m = T_VA.translation();
    pose.orientation_W = Quaterniond(T_VA.linear());
    estimate.poses.push_back(pose);
  }
  return estimate;
}

TEST(EstimatedPath, OfAPerfectEstimateLiesOnTheTruth) {
  sim::Truth truth = spiral();
  for (const scenarios::Frame frame : {scenarios::Frame::imu, scenarios::Frame::body, scenarios::Frame::centre}) {
    for (const double radius_m : {0.0, 0.145}) {
      truth.p_BG_m = radius_m > 0.0 ? Vector3d(0.01, 0.0, -0.02) : Vector3d::Zero();
      sim::Sensors sensors = sensors_of(truth);
      sensors.sphere_radius_m = radius_m;
      const Path expected = true_path(sensors, truth, 10);
      const Path path = estimated_path(perfect_estimate(truth, frame), sensors, truth);
      ASSERT_EQ(path.points_W_m.size(), expected.points_W_m.size());
      for (std::size_t k = 0; k < path.points_W_m.size(); ++k) {
        // the tolerance is the rounding of coordinates of ten metres
        ASSERT_LT((path.points_W_m[k] - expected.points_W_m[k]).norm(), 1e-12) << to_string(frame) << " " << k;
      }
    }
  }
}

TEST(EstimatedPath, ShowsAnErrorOfTheEstimate) {
  const sim::Truth truth = spiral();
  const sim::Sensors sensors = sensors_of(truth);
  scenarios::Estimate estimate = perfect_estimate(truth, scenarios::Frame::imu);
  estimate.poses.back().position_W_m.z() += 0.25;
  const Path path = estimated_path(estimate, sensors, truth);
  EXPECT_NEAR((path.points_W_m.back() - true_path(sensors, truth, 10).points_W_m.back()).z(), 0.25, 1e-12);
}

TEST(EstimatedPath, IsEmptyWithoutPosesOrWithoutItsSensor) {
  const sim::Truth truth = spiral();
  sim::Sensors sensors = sensors_of(truth);
  EXPECT_TRUE(estimated_path({}, sensors, truth).empty());
  const scenarios::Estimate estimate = perfect_estimate(truth, scenarios::Frame::imu);
  sensors.imus.clear();
  EXPECT_TRUE(estimated_path(estimate, sensors, truth).empty());
}

TEST(TruePath, EndsWithTheLastSampleWhateverTheStride) {
  const sim::Truth truth = spiral();
  const Path path = true_path(sensors_of(truth), truth, 300);
  EXPECT_EQ(path.time_ns.size(), 8u);  // 0, 300, ... 1800, 2000
  EXPECT_EQ(path.time_ns.back(), 2000 * kPeriodNs);
  EXPECT_EQ(path.points_W_m.back(), truth.p_WB_m.back());
  EXPECT_TRUE(true_path({}, sim::Truth(), 10).empty());
}

TEST(NearTruth, EndsAPathWhereItRunsAway) {
  const Path truth{{0, 1, 2}, {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}};  // widened by half of its diagonal: 4 m
  const Path path{{0, 1, 2, 3}, {{0, 0, 0}, {5, 3.9, 0}, {6, 4.1, 0}, {7, 0, 0}}};
  const Path shown = near_truth(path, truth);
  ASSERT_EQ(shown.points_W_m.size(), 2u) << "what comes back is not joined by a line through nowhere";
  EXPECT_EQ(shown.time_ns.size(), 2u);
  EXPECT_EQ(near_truth(truth, truth).points_W_m.size(), 3u);
  EXPECT_EQ(near_truth(path, {}).points_W_m.size(), 4u) << "nothing to be near to";
}

TEST(MovingSpan, LeavesTheRestsOut) {
  const sim::Truth truth = spiral();
  EXPECT_EQ(moving_span(truth, 0.0).begin_ns, 501 * kPeriodNs);
  EXPECT_EQ(moving_span(truth, 0.0).end_ns, 1500 * kPeriodNs);
  EXPECT_EQ(moving_span(truth, 0.2).begin_ns, 301 * kPeriodNs);
  EXPECT_EQ(moving_span(truth, 9.0).begin_ns, 0);
  EXPECT_EQ(moving_span(truth, 9.0).end_ns, 2000 * kPeriodNs);
  sim::Truth still = truth;
  for (std::size_t k = 0; k < still.p_WB_m.size(); ++k) still.v_WB_m_s[k] = still.w_WB_B_rad_s[k] = Vector3d::Zero();
  EXPECT_EQ(moving_span(still, 0.0).end_ns, 2000 * kPeriodNs);
}

}  // namespace
}  // namespace tumble::tools
