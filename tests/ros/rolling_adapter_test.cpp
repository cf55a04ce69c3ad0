// SPDX-License-Identifier: BSD-3-Clause
// The test checks that RollingAdapter publishes the library's poses bit for bit.
#include "tumble_ros/rolling_adapter.hpp"

#include "estimator/tests/live_readings.hpp"
#include "estimator/tests/rolled_sphere.hpp"
#include "recorded_outputs.hpp"
#include "tests/testing.hpp"

namespace tumble {

namespace {

TEST(RollingAdapter, PublishesTheLibrarysResultsBitForBit) {
  for (const std::size_t units : {std::size_t{1}, std::size_t{2}}) {
    const std::vector<Vector3d> positions(test::kPositions.begin(), test::kPositions.begin() + long(units));
    ros::RollingAdapter::Params params;
    params.odometry = test::params_of(positions);
    test::RecordedOutputs got;
    ros::RollingAdapter adapter(params, got);
    RollingOdometry odometry(params.odometry);
    std::vector<std::vector<ImuSample>> readings;
    for (const Vector3d& position : positions) readings.push_back(test::noisy(test::unit_at(position)));
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
      EXPECT_EQ(got.sweeps[k].T_OB.translation(), poses[k].pose.position_W_m);
      EXPECT_EQ(got.sweeps[k].pose_covariance, poses[k].pose.covariance);
    }
    // the sphere rolls without slip, so its speed follows from its rotation
    const ros::Odometry& middle = got.sweeps[got.sweeps.size() / 2];
    EXPECT_NEAR(middle.twist_B.head<3>().norm(), test::kRadius_m * middle.twist_B.tail<3>().norm(), 0.02);
    EXPECT_GT(middle.twist_B.head<3>().norm(), 0.3) << "negative control: the sphere rolls";
    EXPECT_TRUE(got.health.back().second.ok) << got.health.back().second.message;
  }
}

// The sphere rolls along x with the speed of its rotation, in closed form.
TEST(RollingAdapter, TheTwistHasItsStatedAccuracy) {
  for (const double lag_s : {0.0, 0.5}) {
    ros::RollingAdapter::Params params;
    params.odometry = test::params_of({test::kPositions[0]});
    params.odometry.lag_s = lag_s;
    test::RecordedOutputs got;
    ros::RollingAdapter adapter(params, got);
    for (const ImuSample& sample : test::noisy(test::unit_at(test::kPositions[0]))) adapter.on_imu(0, sample);
    double nees = 0.0;
    std::size_t count = 0;
    for (const ros::Odometry& odometry : got.sweeps) {
      const double t_s = 1e-9 * double(odometry.stamp_ns), h_s = 1e-4;
      if (t_s < test::kRest_s + 0.3 || t_s > test::kRest_s + test::kRoll_s - 0.3) continue;
      const double speed_m_s =
          test::kRadius_m * (test::angle_rad(t_s + h_s) - test::angle_rad(t_s - h_s)) / (2.0 * h_s);
      const Vector3d v_B =
          Eigen::AngleAxisd(test::angle_rad(t_s), Eigen::Vector3d::UnitY()).inverse() * Vector3d(speed_m_s, 0.0, 0.0);
      const Vector3d error = odometry.twist_B.head<3>() - v_B;
      const Matrix3d covariance = odometry.twist_covariance.topLeftCorner<3, 3>();
      EXPECT_GT(covariance.diagonal().minCoeff(), 0.0);
      EXPECT_GT(odometry.twist_covariance(5, 5), 0.0);
      nees += error.dot(covariance.ldlt().solve(error)) / 3.0;
      ++count;
    }
    ASSERT_GT(count, 300u);
    EXPECT_LT(nees / double(count), 4.0) << "1 is consistent; one run, whose errors are correlated; lag " << lag_s;
    EXPECT_GT(nees / double(count), 0.01) << "lag " << lag_s;
  }
}

TEST(RollingAdapter, ResetStartsAtTheGivenPose) {
  ros::RollingAdapter::Params params;
  params.odometry = test::params_of({test::kPositions[0]});
  test::RecordedOutputs got;
  ros::RollingAdapter adapter(params, got);
  adapter.reset(Isometry3d(Eigen::Translation3d(5.0, 6.0, 0.1)));
  for (const ImuSample& sample : test::noisy(test::unit_at(test::kPositions[0]))) adapter.on_imu(0, sample);
  ASSERT_FALSE(got.newest.empty());
  EXPECT_NEAR(got.newest.front().T_OB.translation().y(), 6.0, 1e-3);
}

}  // namespace

}  // namespace tumble
