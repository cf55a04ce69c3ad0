// SPDX-License-Identifier: BSD-3-Clause
// The test compares the odometry of the base frame with the closed form and with sampled errors, and the deskewed
// points with the room.
#include "tumble_ros/publisher.hpp"

#include "estimator/tests/thrown_body.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

using ros::Matrix6;
using ros::Vector6;

PoseState some_pose() {
  PoseState out;
  out.time_ns = 7;
  out.position_W_m = {1.0, -2.0, 3.0};
  out.orientation_W = so3::exp({0.4, -1.1, 2.0});
  out.velocity_W_m_s = {0.5, 1.5, -0.7};
  return out;
}

Isometry3d some_base() {  // in IMU axes
  return Eigen::Translation3d(0.3, -0.2, 0.6) * so3::exp({1.0, 0.3, -0.8});
}

template <int N>
Eigen::Matrix<double, N, N> some_covariance(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto root = Eigen::Matrix<double, N, N>::NullaryExpr([&] { return normal(random); }).eval();
  return 1e-6 * root * root.transpose();
}

TEST(BaseOdometry, IsThePoseAndTwistOfTheBase) {
  const PoseState imu = some_pose();
  const Isometry3d T_IB = some_base();
  AngularRateState rate;
  rate.w_WI_I_rad_s = {2.0, -1.0, 0.5};
  const ros::Odometry odometry = ros::base_odometry(imu, Eigen::Matrix3d::Zero(), rate, T_IB);
  const Isometry3d T_OI = Eigen::Translation3d(imu.position_W_m) * imu.orientation_W;
  EXPECT_TRUE(odometry.T_OB.isApprox(T_OI * T_IB, 1e-12));
  EXPECT_EQ(odometry.stamp_ns, 7);
  // the velocity of the base comes from a difference over 20 us, which is exact to 1e-9; it is then turned into axes of
  // the base
  constexpr double kStep_s = 1e-5;
  const auto moved = [&](double t_s) {
    return Isometry3d(Eigen::Translation3d(imu.position_W_m + t_s * imu.velocity_W_m_s) *
                      (imu.orientation_W * so3::exp(t_s * rate.w_WI_I_rad_s)) * T_IB);
  };
  const Vector3d v_O = (moved(kStep_s).translation() - moved(-kStep_s).translation()) / (2.0 * kStep_s);
  const Matrix3d R_BO = odometry.T_OB.linear().transpose();
  const Vector3d w_B = so3::logarithm(Quaterniond(R_BO * moved(kStep_s).linear())) / kStep_s;
  EXPECT_TRUE(odometry.twist_B.head<3>().isApprox(R_BO * v_O, 1e-8));
  EXPECT_TRUE(odometry.twist_B.tail<3>().isApprox(w_B, 1e-8));
  EXPECT_FALSE(odometry.twist_B.head<3>().isApprox(v_O, 0.1)) << "negative control: axes of the odometry frame";
}

// The test draws errors of the inputs and compares the covariance of the resulting errors of the base, in ROS' order
// and axes.
TEST(BaseOdometry, CovariancesAreThoseOfSampledErrors) {
  std::mt19937 random(1);
  PoseState imu = some_pose();
  const Isometry3d T_IB = some_base();
  AngularRateState rate;
  rate.w_WI_I_rad_s = {2.0, -1.0, 0.5};
  imu.covariance = some_covariance<6>(random);
  rate.covariance_rad2_s2 = some_covariance<3>(random);
  const Matrix3d velocity_I = some_covariance<3>(random);
  const ros::Odometry stated = ros::base_odometry(imu, velocity_I, rate, T_IB);

  std::normal_distribution<double> normal;
  const auto draw = [&](const auto& covariance) {
    const Eigen::MatrixXd root = Eigen::MatrixXd(covariance).llt().matrixL();
    return Eigen::VectorXd(root * Eigen::VectorXd::NullaryExpr(root.cols(), [&] { return normal(random); }));
  };
  Matrix6 pose = Matrix6::Zero(), twist = Matrix6::Zero();
  constexpr int kDraws = 20000;
  for (int k = 0; k < kDraws; ++k) {
    const Eigen::VectorXd error = draw(imu.covariance);
    PoseState wrong = imu;
    wrong.position_W_m += error.head<3>();
    wrong.orientation_W = so3::exp(error.tail<3>()) * imu.orientation_W;
    // the velocity's covariance is stated in IMU axes, so the sampled velocity turns with the attitude
    const Vector3d v_I = imu.orientation_W.conjugate() * imu.velocity_W_m_s + Vector3d(draw(velocity_I));
    wrong.velocity_W_m_s = wrong.orientation_W * v_I;
    AngularRateState wrong_rate = rate;
    wrong_rate.w_WI_I_rad_s += draw(rate.covariance_rad2_s2);
    const ros::Odometry drawn = ros::base_odometry(wrong, velocity_I, wrong_rate, T_IB);
    Vector6 off;
    off << drawn.T_OB.translation() - stated.T_OB.translation(),
        so3::logarithm(Quaterniond(drawn.T_OB.linear() * stated.T_OB.linear().transpose()));
    pose += off * off.transpose() / kDraws;
    const Vector6 twist_off = drawn.twist_B - stated.twist_B;
    twist += twist_off * twist_off.transpose() / kDraws;
  }
  // a sampled covariance of 20 000 draws lies within 5 % of its norm; that bound is more than five standard deviations
  EXPECT_TRUE(pose.isApprox(stated.pose_covariance, 0.05)) << pose << "\n\n" << stated.pose_covariance;
  EXPECT_TRUE(twist.isApprox(stated.twist_covariance, 0.05)) << twist << "\n\n" << stated.twist_covariance;
  EXPECT_FALSE(pose.isApprox(imu.covariance, 0.05)) << "negative control: the IMU's covariance is another one";
}

TEST(Deskew, PointsOfASpinningBodyAreThoseOfAStandingOne) {
  const test::ThrownBody body;
  const auto sweeps = body.sweeps();
  const auto sweep =
      std::find_if(sweeps.begin(), sweeps.end(), [](const auto& each) { return each.start_ns > 1'500'000'000; });
  ASSERT_NE(sweep, sweeps.end());
  std::vector<PoseState> trajectory;
  for (TimeNs time_ns = sweep->start_ns + 10'000'000; time_ns <= sweep->end_ns; time_ns += 10'000'000) {
    const Isometry3d T = body.T_WI(1e-9 * double(time_ns));
    PoseState& pose = trajectory.emplace_back();
    pose.time_ns = time_ns;
    pose.position_W_m = T.translation();
    pose.orientation_W = Quaterniond(T.linear());
  }
  std::vector<ros::DeskewedPoint> deskewed;
  ros::deskew(trajectory, Eigen::Isometry3d::Identity(), sweep->start_ns, sweep->points, deskewed);
  ASSERT_EQ(deskewed.size(), sweep->points.size());
  const Isometry3d T_end = body.T_WI(1e-9 * double(sweep->end_ns));
  double worst_m = 0.0, worst_raw_m = 0.0;
  for (std::size_t i = 0; i < deskewed.size(); ++i) {
    const Vector3d raw = sweep->points[i].position_L_m.cast<double>();
    const Vector3d truth =
        T_end.inverse() * (body.T_WI(1e-9 * double(sweep->start_ns + sweep->points[i].offset_ns)) * raw);
    worst_m = std::max(worst_m, (deskewed[i].position_L_m.cast<double>() - truth).norm());
    worst_raw_m = std::max(worst_raw_m, (raw - truth).norm());
  }
  // (a h^2 / 8 with 10 ms between poses and 30 m/s^2 at the IMU is 0.4 mm; twice this if the first pose is
  // extrapolated)
  EXPECT_LT(worst_m, 4e-3);
  EXPECT_GT(worst_raw_m, 1.0) << "negative control: the body turns by 1.5 rad in the sweep";
}

}  // namespace

}  // namespace tumble
