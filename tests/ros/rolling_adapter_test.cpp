// SPDX-License-Identifier: BSD-3-Clause
// The test checks that RollingAdapter publishes the library's poses bit for bit.
#include "tumble_ros/rolling_adapter.hpp"

#include <gtest/gtest.h>

#include "estimator/tests/live_readings.hpp"
#include "estimator/tests/rolled_sphere.hpp"
#include "recorded_outputs.hpp"

namespace tumble {

namespace {

TEST(RollingAdapter, PublishesTheLibrarysResultsBitForBit) {
  for (const std::size_t units : {std::size_t{1}, std::size_t{2}}) {
    const std::vector<Eigen::Vector3d> positions(test::kPositions.begin(), test::kPositions.begin() + long(units));
    ros::RollingAdapter::Params params;
    params.odometry = test::params_of(positions);
    test::RecordedOutputs got;
    ros::RollingAdapter adapter(params, got);
    RollingOdometry odometry(params.odometry);
    std::vector<std::vector<ImuSample>> readings;
    for (const Eigen::Vector3d& position : positions) readings.push_back(test::noisy(test::unit_at(position)));
    std::vector<RollingOdometry::Pose> poses, newest;
    for (std::size_t k = 0; k < readings[0].size(); ++k) {
      for (std::size_t unit = 0; unit < units; ++unit) {
        EXPECT_TRUE(adapter.on_imu(unit, readings[unit][k]).ok());
        units == 1 ? odometry.add_imu(readings[unit][k]) : odometry.add_imu(unit, readings[unit][k]);
        while (const auto pose = odometry.take()) poses.push_back(*pose);
        const auto now = odometry.newest();
        if (now && (newest.empty() || now->pose.time_ns != newest.back().pose.time_ns)) newest.push_back(*now);
      }
    }
    ASSERT_GT(poses.size(), 500u);
    ASSERT_EQ(got.sweeps.size(), poses.size());
    ASSERT_EQ(got.newest.size(), newest.size());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      EXPECT_EQ(got.sweeps[k].T_OB.translation(), poses[k].pose.p_WA_m);
      EXPECT_EQ(got.sweeps[k].pose_covariance, poses[k].pose.covariance);
    }
    // the sphere rolls without slip, so its speed follows from its rotation
    const ros::Odometry& middle = got.sweeps[got.sweeps.size() / 2];
    EXPECT_NEAR(middle.twist_B.head<3>().norm(), test::kRadius_m * middle.twist_B.tail<3>().norm(), 0.02);
    EXPECT_GT(middle.twist_B.head<3>().norm(), 0.3) << "negative control: the sphere rolls";
    EXPECT_TRUE(got.health.back().second.ok) << got.health.back().second.message;
  }
}

TEST(RollingAdapter, ResetStartsAtTheGivenPose) {
  ros::RollingAdapter::Params params;
  params.odometry = test::params_of({test::kPositions[0]});
  test::RecordedOutputs got;
  ros::RollingAdapter adapter(params, got);
  adapter.reset(Eigen::Isometry3d(Eigen::Translation3d(5.0, 6.0, 0.1)));
  for (const ImuSample& sample : test::noisy(test::unit_at(test::kPositions[0]))) adapter.on_imu(0, sample);
  ASSERT_FALSE(got.newest.empty());
  EXPECT_NEAR(got.newest.front().T_OB.translation().y(), 6.0, 1e-3);
}

}  // namespace

}  // namespace tumble
