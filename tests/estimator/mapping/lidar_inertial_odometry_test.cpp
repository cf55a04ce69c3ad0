// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include "tests/estimator/mapping/room_tumble.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using Odometry = LidarInertialOdometry;
using test::add_sweep;
using test::error_of;
using test::feed_imu;
using test::kSamplesPerSweep;
using test::rig_params;
using test::run;
using test::same;

TEST(LidarInertialOdometry, FollowsATumbleThroughARoom) {
  Odometry odometry(rig_params());
  const auto reports = run(odometry, 0, 26);
  EXPECT_EQ(reports[0].verdict, SweepVerdict::first);
  int registered = 0;
  for (std::size_t i = 1; i < reports.size(); ++i) {
    // the map of a sensor at rest consists of rings, and is filled once the spin begins
    EXPECT_NE(reports[i].verdict, SweepVerdict::rejected) << "sweep " << i;
    registered += reports[i].verdict == SweepVerdict::registered;
    EXPECT_GT(reports[i].inlier_ratio, i < 4 ? 0.15 : 0.35) << "sweep " << i;
    ASSERT_EQ(reports[i].trajectory.size(), static_cast<std::size_t>(kSamplesPerSweep));
    EXPECT_EQ(reports[i].trajectory.back().time_ns, static_cast<TimeNs>(i + 1) * test::kSweep_ns);
    EXPECT_LT(error_of(reports[i].pose).m, 0.05) << "sweep " << i;
  }
  EXPECT_GT(registered, 20);
  const test::PoseError end = error_of(reports.back().pose);
  // most of the error comes from the first moving sweep against rings; measured 0.025 m, 0.0013 rad, 0.01 m/s
  EXPECT_LT(end.m, 0.04);
  EXPECT_LT(end.rad, 0.003);
  EXPECT_LT(end.m_s, 0.05);

  // the map points are on the surfaces, and their normals point to the sensor's side
  const std::vector<MapPoint> map = odometry.map();
  ASSERT_GT(map.size(), 10'000u);
  std::size_t near = 0, with_normal = 0, inwards = 0;
  const test::Room room = test::Room::box();
  for (const MapPoint& point : map) {
    const Eigen::Vector3d p = point.position_W_m.cast<double>();
    near += test::Room::box_with_pillars().distance(p) < 0.1;
    if (point.normal_W.isZero()) continue;
    ++with_normal;
    EXPECT_NEAR(point.normal_W.norm(), 1.0f, 1e-5f);
    // normals of pillars point outwards
    inwards += point.normal_W.cast<double>().dot(-p) > 0.0 || room.distance(p) > 0.2;
  }
  EXPECT_GT(static_cast<double>(near) / static_cast<double>(map.size()), 0.98);
  EXPECT_GT(static_cast<double>(with_normal) / static_cast<double>(map.size()), 0.7);
  EXPECT_GT(static_cast<double>(inwards) / static_cast<double>(with_normal), 0.98);
}

TEST(LidarInertialOdometry, ThreeTimesTheVoxelRegistersAQuarterOfThePoints) {
  std::array<double, 2> points{};
  for (std::size_t k = 0; k < points.size(); ++k) {
    Odometry::Params params = rig_params();
    params.sweep_voxel_m *= k == 0 ? 1.0 : 3.0;
    Odometry odometry(params);
    const auto reports = run(odometry, 0, 16);
    for (const auto& report : reports) points[k] += static_cast<double>(report.points_after_downsampling);
    EXPECT_LT(error_of(reports.back().pose).m, 0.1);
  }
  EXPECT_NEAR(points[1] / points[0], 0.25, 0.1);
}

TEST(LidarInertialOdometry, IsLostWithAClippedRate) {
  Odometry odometry(rig_params());
  const auto reports = run(odometry, 0, 26, 8.0);
  const test::PoseError end = error_of(reports.back().pose);
  EXPECT_GT(end.m + end.rad, 0.5);  // negative control of the test above
}

TEST(LidarInertialOdometry, FindsTheDeficitOfClippedAxesByItself) {
  Odometry::Params params = rig_params();
  params.expert.saturated_imu.estimate_deficit = true;
  Odometry odometry(params);
  const auto reports = run(odometry, 0, 26, 8.0);
  const test::PoseError end = error_of(reports.back().pose);
  EXPECT_LT(end.m, 0.15);
  EXPECT_LT(end.rad, 0.02);
  EXPECT_GT(reports.back().mean_saturation_deficit_I_rad_s.maxCoeff(), 1.0);
}

TEST(LidarInertialOdometry, RestartsBitByBitFromACopy) {
  Odometry whole(rig_params());
  const auto before = run(whole, 0, 9);
  // in the middle of a sweep's samples
  for (int k = 90; k < 94; ++k) {
    ASSERT_TRUE(whole
                    .add_imu(test::room_tumble().imu[static_cast<std::size_t>(k)],
                             test::believe(test::room_tumble().imu[static_cast<std::size_t>(k)]))
                    .ok());
  }
  Odometry copy(whole);
  Odometry assigned(rig_params());
  assigned = whole;
  for (Odometry* odometry : {&whole, &copy, &assigned}) {
    for (int k = 94; k < 100; ++k) {
      const ImuSample& sample = test::room_tumble().imu[static_cast<std::size_t>(k)];
      ASSERT_TRUE(odometry->add_imu(sample, test::believe(sample)).ok());
    }
  }
  for (int i = 9; i < 13; ++i) {
    Odometry::SweepResult a, b, c;
    ASSERT_TRUE(add_sweep(whole, i, test::room_tumble().sweeps[static_cast<std::size_t>(i)], a).ok());
    ASSERT_TRUE(add_sweep(copy, i, test::room_tumble().sweeps[static_cast<std::size_t>(i)], b).ok());
    ASSERT_TRUE(add_sweep(assigned, i, test::room_tumble().sweeps[static_cast<std::size_t>(i)], c).ok());
    EXPECT_TRUE(same(a, b)) << "sweep " << i;
    EXPECT_TRUE(same(a, c)) << "sweep " << i;
    EXPECT_FALSE(same(a, before.back())) << "the comparison is blind";
    if (i == 12) break;
    feed_imu(whole, i + 1);
    feed_imu(copy, i + 1);
    feed_imu(assigned, i + 1);
  }
}

TEST(LidarInertialOdometry, SaysThatAFloorAloneDoesNotHoldIt) {
  Odometry odometry(rig_params());
  int degenerate = 0;
  for (int i = 0; i < 10; ++i) {
    feed_imu(odometry, i);
    const auto points = test::make_sweep(test::Room::floor_only(), test::room_tumble().motion, rig_params().T_IL, i,
                                         test::kRoomNoise_m);
    Odometry::SweepResult report;
    ASSERT_TRUE(add_sweep(odometry, i, points, report).ok());
    EXPECT_NE(report.verdict, SweepVerdict::registered) << "sweep " << i << " conditioning " << report.eigenvalue_ratio;
    if (report.verdict != SweepVerdict::degenerate || report.eigenvalue_ratio == 0.0) continue;
    ++degenerate;
    const auto& d = report.least_constrained_pose_direction_W;
    EXPECT_GT(std::hypot(d[0], d[1], d[5]), 0.95) << d.transpose();
  }
  EXPECT_GT(degenerate, 3);  // at rest, its rings determine no plane
}

/// A plane without noise leaves directions undetermined to the last bit: the ratio of smallest to largest eigenvalue is
/// 0. The directions that it determines are still aligned.
TEST(LidarInertialOdometry, AnExactlyDegenerateAlignmentCounts) {
  const auto plane = [](float height_m) {
    std::vector<LidarPoint> points;
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        LidarPoint& point = points.emplace_back();
        point.position_L_m = {0.25f * static_cast<float>(i), 0.25f * static_cast<float>(j), height_m};
        point.offset_ns = static_cast<TimeNs>(points.size()) * 10'000;
        point.ring = static_cast<std::uint16_t>(i + 40);
      }
    }
    return points;
  };
  Odometry::Params params;
  params.T_IL.setIdentity();
  Odometry odometry(params);
  Odometry::SweepResult report;
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int k = sweep * kSamplesPerSweep; k < (sweep + 1) * kSamplesPerSweep; ++k) {
      ImuSample sample;
      sample.time_ns = (k + 1) * test::kSweep_ns / kSamplesPerSweep;
      // rotation about the plane's normal, so the sensor is not at rest
      sample.angular_velocity_rad_s = {0.0, 0.0, sweep == 0 ? 0.0 : 0.5};
      sample.specific_force_m_s2 = {0.0, 0.0, params.expert.gravity_m_s2};
      ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    // the second sweep measures the plane 5 mm nearer than the inertial prediction
    ASSERT_TRUE(add_sweep(odometry, sweep, plane(sweep == 0 ? -1.5f : -1.495f), report).ok());
  }
  EXPECT_EQ(report.verdict, SweepVerdict::degenerate);
  EXPECT_EQ(report.eigenvalue_ratio, 0.0);
  EXPECT_GT(report.iterations, 0);
  EXPECT_NEAR(report.pose.position_W_m.z(), -0.005, 0.002);
  EXPECT_GT(report.normalised_innovation, 0.0);
}

TEST(LidarInertialOdometry, LevelsAtRest) {
  // tilted start: gravity determines roll and pitch, yaw is zero
  const Eigen::Quaterniond q_true = so3::exp({0.0, 0.3, 0.0}) * so3::exp({0.2, 0.0, 0.0});
  Odometry odometry(rig_params());
  for (int k = 1; k <= 10; ++k) {
    ImuSample sample;
    sample.time_ns = k * 10'000'000;
    sample.specific_force_m_s2 = q_true.conjugate() * Eigen::Vector3d(0, 0, 9.80665);
    ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
  }
  Odometry::SweepResult report;
  ASSERT_TRUE(add_sweep(odometry, 0, test::room_tumble().sweeps[0], report).ok());
  EXPECT_LT(so3::logarithm(report.pose.orientation_W * q_true.conjugate()).norm(), 1e-12);
  EXPECT_LT(report.pose.position_W_m.norm(), 1e-12);
}

}  // namespace
}  // namespace tumble
