// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/room_rig.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

// tests wrong calibration at the start, and tracking failure with recovery
namespace tumble {
namespace {

using Odometry = LidarInertialOdometry;

using test::kHalfColumns;
using test::kRoomNoise_m;
using test::kSamplesPerSweep;
using test::slower;
using test::true_params;
using Rig = test::RoomRig;

/// Returns a spin whose axis rotates in the body: with a fixed axis, a late clock and a rotated mounting would be
/// indistinguishable.
test::Motion turning() {
  test::Motion motion;
  motion.spin_rad_s = 5.0;
  motion.second_spin_rad_s = 5.0;
  return motion;
}

/// Runs with a mounting that is wrong by a degree and a centimetre, and a lidar clock that is 4 ms late.
void run_miscalibrated(Odometry& odometry, const test::Motion& motion, int sweeps) {
  constexpr std::int64_t kLate_ns = 4'000'000;
  const std::vector<ImuSample> imu = test::make_imu(motion, 0.1 * sweeps + 0.1);
  std::size_t next = 0;
  for (int k = 1; k < sweeps; ++k) {
    const std::int64_t start_ns = k * test::kSweep_ns - kLate_ns;
    while (next < imu.size() && (next == 0 || imu[next - 1].time_ns < start_ns + test::kSweep_ns + 20'000'000)) {
      ASSERT_TRUE(odometry.add_imu(imu[next], test::believe(imu[next])).ok());
      ++next;
    }
    Odometry::SweepResult report;
    const auto points =
        test::make_sweep(test::Room::box_with_pillars(), motion, true_params().T_IL, k, kRoomNoise_m, kHalfColumns);
    ASSERT_TRUE(odometry.add_sweep(start_ns, start_ns + test::kSweep_ns, points, report).ok());
    ASSERT_NE(report.verdict, SweepVerdict::rejected) << k;
  }
}

/// Returns a motion in which a second without readings causes no tracking failure.
test::Motion gentle() {
  test::Motion motion;
  motion.spin_rad_s = 0.8;
  motion.second_spin_rad_s = 0.3;
  motion.swing = 0.5;
  return motion;
}

TEST(Calibration, FindsMountingAndClock) {
  Odometry::Params params = true_params();
  params.T_IL.linear() = so3::exp({0.010, -0.012, 0.008}).toRotationMatrix() * params.T_IL.linear();
  params.T_IL.translation() += Eigen::Vector3d(0.006, -0.005, 0.006);
  params.mount_sigma_rad = 0.01;
  params.mount_sigma_m = 0.006;
  params.time_offset_sigma_s = 0.003;
  params.expert.gravity_sigma_m_s2 = 0.03;
  Odometry odometry(params);
  run_miscalibrated(odometry, turning(), 40);
  // the first map was built with the wrong calibration; its calibration result starts a second map
  const auto learnt_sigma = odometry.next_lidar_calibration_prior_covariance().diagonal().cwiseSqrt().eval();
  params.T_IL = odometry.lidar_calibration().T_IL;
  params.imu_minus_lidar_clock_s = odometry.lidar_calibration().imu_minus_lidar_clock_s;
  params.mount_sigma_rad = learnt_sigma.head<3>().maxCoeff();
  params.mount_sigma_m = learnt_sigma.segment<3>(3).maxCoeff();
  params.time_offset_sigma_s = learnt_sigma[6];
  odometry = Odometry(params);
  run_miscalibrated(odometry, turning(), 40);
  LidarImuCalibration truth;
  truth.T_IL = true_params().T_IL;
  truth.imu_minus_lidar_clock_s = 0.004;
  const auto error = odometry.lidar_calibration().minus(truth);
  const auto sigma = odometry.lidar_calibration_covariance().diagonal().cwiseSqrt().eval();
  // stated: errors of 0.018 rad, 10 mm, 4 ms; measured: 0.0022 rad, 0.4 mm, 0.44 ms
  EXPECT_LT(error.head<3>().norm(), 0.003);
  EXPECT_LT(error.segment<3>(3).norm(), 0.005);
  EXPECT_LT(std::abs(error[6]), 5e-4);
  for (int i = 0; i < 7; ++i) EXPECT_LT(std::abs(error[i]), 5.0 * sigma[i] + 1e-4) << "component " << i;
}

TEST(Calibration, IsLeftAloneWhereItIsExact) {
  Odometry odometry(true_params());
  const LidarImuCalibration before = odometry.lidar_calibration();
  run_miscalibrated(odometry, slower(), 6);
  EXPECT_EQ(odometry.lidar_calibration().minus(before).head<7>().norm(), 0.0);
  EXPECT_EQ(odometry.lidar_calibration_covariance().norm(), 0.0);
}

TEST(Recovery, FindsItselfAfterThreeSecondsUnderACover) {
  Rig rig(true_params());
  rig.run(0, 20);
  ASSERT_EQ(rig.report.verdict, SweepVerdict::registered);
  const double sigma_before = std::sqrt(rig.report.pose.covariance(0, 0));
  for (int k = 20; k < 50; ++k) {
    // a gyro with drift: the inertial prior alone has a final error of at least 0.15 rad and half a metre
    rig.feed_imu(k, {0.03, -0.03, 0.03});
    EXPECT_EQ(rig.sweep(k, {}).error_code, ErrorCode::empty);
    ASSERT_EQ(rig.report.verdict, SweepVerdict::rejected);
    EXPECT_EQ(rig.report.consecutive_rejected_sweeps, k - 19);
  }
  EXPECT_GT(rig.error_m(), 0.3);  // tracking has failed
  EXPECT_GT(std::sqrt(rig.report.pose.covariance(0, 0)), 10.0 * sigma_before);
  EXPECT_LT(rig.error_m(), 5.0 * std::sqrt(rig.report.pose.covariance.topLeftCorner<3, 3>().trace()));
  rig.run(50, 56);
  EXPECT_EQ(rig.report.verdict, SweepVerdict::registered);
  EXPECT_EQ(rig.report.consecutive_rejected_sweeps, 0);
  EXPECT_LT(rig.error_m(), 0.06);
}

TEST(Recovery, BridgesAGapOfASecondInBothSensors) {
  Rig rig(true_params(), gentle());
  rig.run(0, 20);
  rig.run(30, 39);  // sweeps and samples of a second are missing; the next sample bridges the gap
  EXPECT_NE(rig.report.verdict, SweepVerdict::rejected);
  EXPECT_LT(rig.error_m(), 0.1);
}

TEST(Recovery, ADegenerateSegmentIsSaidAndLeft) {
  Rig rig(true_params());
  rig.run(0, 15);
  ASSERT_EQ(rig.report.verdict, SweepVerdict::registered);
  for (int k = 15; k < 20; ++k) {
    rig.feed_imu(k);
    const auto floor =
        test::make_sweep(test::Room::floor_only(), rig.motion, true_params().T_IL, k, kRoomNoise_m, kHalfColumns);
    ASSERT_TRUE(rig.sweep(k, floor).ok());
    EXPECT_EQ(rig.report.verdict, SweepVerdict::degenerate) << k;
    // the prior constrains the free directions, and the floor the others
    EXPECT_LT(rig.error_m(), 0.1);
  }
  rig.run(20, 24);
  EXPECT_EQ(rig.report.verdict, SweepVerdict::registered);
  EXPECT_LT(rig.error_m(), 0.05);
}

// the same tumble with an IMU of another mounting
TEST(Equivariance, ToARotatedMounting) {
  const Eigen::Matrix3d turn = so3::exp({0.4, -1.1, 0.7}).toRotationMatrix();
  Odometry::Params turned = true_params();
  turned.T_IL = Eigen::Isometry3d(Eigen::Quaterniond(turn)) * turned.T_IL;
  Odometry a(true_params()), b(turned);
  const test::Motion motion = slower();
  const std::vector<ImuSample> imu = test::make_imu(motion, 1.5);
  Odometry::SweepResult ra, rb;
  for (int k = 0; k < 12; ++k) {
    for (int j = k * kSamplesPerSweep; j < (k + 1) * kSamplesPerSweep; ++j) {
      ImuSample sample = imu[static_cast<std::size_t>(j)];
      ASSERT_TRUE(a.add_imu(sample, test::believe(sample)).ok());
      sample.angular_velocity_rad_s = turn * sample.angular_velocity_rad_s;
      sample.specific_force_m_s2 = turn * sample.specific_force_m_s2;
      ASSERT_TRUE(b.add_imu(sample, test::believe(sample)).ok());
    }
    const auto points =
        test::make_sweep(test::Room::box_with_pillars(), motion, true_params().T_IL, k, kRoomNoise_m, kHalfColumns);
    ASSERT_TRUE(a.add_sweep(k * test::kSweep_ns, (k + 1) * test::kSweep_ns, points, ra).ok());
    ASSERT_TRUE(b.add_sweep(k * test::kSweep_ns, (k + 1) * test::kSweep_ns, points, rb).ok());
  }
  // yaw is zero at the start in both runs: the heading of the world differs by the effect of levelling on the mounting
  const Eigen::Quaterniond world = rb.pose.orientation_W * Eigen::Quaterniond(turn) * ra.pose.orientation_W.conjugate();
  EXPECT_LT(std::abs(world.x()) + std::abs(world.y()), 2e-3);
  // the selection of points per voxel depends on the heading: registration noise
  EXPECT_LT((world * ra.pose.position_W_m - rb.pose.position_W_m).norm(), 0.03);
  EXPECT_GT((ra.pose.position_W_m).norm(), 0.3);  // the sensor moved
}

/// Returns the lidar points on one side of the room only, by their true positions.
std::vector<LidarPoint> on_side(const Rig& rig, int sweep, double from_x_m, double to_x_m) {
  std::vector<LidarPoint> points = rig.points(sweep);
  std::erase_if(points, [&](const LidarPoint& point) {
    const double t = 1e-9 * static_cast<double>(sweep * test::kSweep_ns + point.offset_ns);
    const double x_m = (rig.motion.pose(t) * true_params().T_IL * point.position_L_m.cast<double>()).x();
    return x_m < from_x_m || x_m > to_x_m;
  });
  return points;
}

// after eight sweeps of one side, the ninth shows the other side, beyond any match: only the prior can insert it
TEST(Recovery, ASweepOfUnknownGroundExtendsTheMap) {
  Rig rig(true_params());
  constexpr double kFar_m = 100.0;
  for (int k = 0; k < 8; ++k) {
    rig.feed_imu(k);
    ASSERT_TRUE(rig.sweep(k, on_side(rig, k, 3.0, kFar_m)).ok());
  }
  const std::size_t before = rig.odometry.map().size();
  rig.feed_imu(8);
  ASSERT_TRUE(rig.sweep(8, on_side(rig, 8, -kFar_m, 1.5)).ok());
  EXPECT_EQ(rig.report.verdict, SweepVerdict::degenerate);
  EXPECT_EQ(rig.report.eigenvalue_ratio, 0.0);  // not aligned
  EXPECT_GT(rig.report.map_points_added, 1000u);
  EXPECT_EQ(rig.odometry.map().size(), before + rig.report.map_points_added);
  rig.feed_imu(9);
  ASSERT_TRUE(rig.sweep(9, on_side(rig, 9, -kFar_m, 1.5)).ok());
  EXPECT_EQ(rig.report.verdict, SweepVerdict::registered);  // to the points of the previous sweep
  EXPECT_EQ(rig.report.consecutive_rejected_sweeps, 0);
  EXPECT_LT(rig.error_m(), 0.03);  // measured: 4 mm
}

TEST(Recovery, SaysAndSurvivesAGapOfASecondInTheImuAlone) {
  Rig rig(true_params(), gentle());
  rig.run(0, 20);
  const double sigma_before = std::sqrt(rig.report.pose.covariance(0, 0));
  for (int k = 20; k < 30; ++k) {
    EXPECT_EQ(rig.sweep(k, rig.points(k)).error_code, ErrorCode::insufficient_data);
    EXPECT_EQ(rig.report.verdict, SweepVerdict::rejected);
    EXPECT_TRUE(rig.report.trajectory.empty());  // no pose is reported
  }
  rig.feed_imu(30);
  ASSERT_TRUE(rig.sweep(30, {}).error_code == ErrorCode::empty);  // only the prior bridges the gap
  EXPECT_EQ(rig.report.verdict, SweepVerdict::rejected);
  EXPECT_GT(std::sqrt(rig.report.pose.covariance(0, 0)), 10.0 * sigma_before);
  rig.run(31, 39);
  EXPECT_EQ(rig.report.verdict, SweepVerdict::registered);
  EXPECT_LT(rig.error_m(), 0.1);
}

}  // namespace
}  // namespace tumble
