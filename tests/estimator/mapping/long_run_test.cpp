// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/endless_corridor.hpp"
#include "tests/testing.hpp"

// memory over a long path: distant map points are removed
namespace tumble {
namespace {

TEST(LocalMapSoak, StaysFlatOverTenMinutes) {
  constexpr std::int64_t kSlowSweep_ns = 400'000'000;
  constexpr int kSweeps = 1500;  // 10 min, about 600 m
  constexpr int kSettled = 150;  // 60 m: the start is outside of the map
  const LidarInertialOdometry::Params params = test::corridor_params();
  LidarInertialOdometry odometry(params);
  test::EndlessCorridor corridor(400, kSlowSweep_ns);
  LidarInertialOdometry::SweepResult report;
  std::size_t bytes_early = 0, bytes_late = 0, points_early = 0, lost = 0;
  for (int k = 0; k < kSweeps; ++k) {
    for (const ImuSample& sample : corridor.advance()) {
      ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    ASSERT_TRUE(odometry.add_sweep(corridor.start_ns(), corridor.end_ns(), corridor.points(), report).ok());
    lost += report.verdict == SweepVerdict::rejected;
    if (k < kSettled) {
      bytes_early = std::max(bytes_early, odometry.map_memory_bytes());
    } else {
      bytes_late = std::max(bytes_late, odometry.map_memory_bytes());
    }
    if (k == kSettled) points_early = odometry.map().size();
  }
  EXPECT_GT(corridor.x_m(), 590.0);
  EXPECT_EQ(lost, 0u);
  EXPECT_NEAR(report.pose.position_W_m.x(), corridor.x_m(), 0.02 * corridor.x_m());
  ASSERT_GT(points_early, 500u);
  // the size varies by the points added between two prunings
  EXPECT_LT(static_cast<double>(odometry.map().size()), 1.3 * static_cast<double>(points_early));
  EXPECT_LT(static_cast<double>(bytes_late), 2.1 * static_cast<double>(bytes_early));
  for (const MapPoint& point : odometry.map()) {
    ASSERT_LT((point.position_W_m.cast<double>() - report.pose.position_W_m).norm(), 1.2 * params.expert.map.radius_m);
  }
}

// negative control: with a map larger than the path, memory grows
TEST(LocalMapSoak, GrowsWhereItForgetsNothing) {
  LidarInertialOdometry::Params params = test::corridor_params();
  params.expert.map.radius_m = 1e4;
  LidarInertialOdometry odometry(params);
  test::EndlessCorridor corridor(400);
  LidarInertialOdometry::SweepResult report;
  std::size_t bytes_early = 0;
  for (int k = 0; k < 1500; ++k) {
    for (const ImuSample& sample : corridor.advance()) {
      ASSERT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    ASSERT_TRUE(odometry.add_sweep(corridor.start_ns(), corridor.end_ns(), corridor.points(), report).ok());
    if (k == 500) bytes_early = odometry.map_memory_bytes();
  }
  EXPECT_GT(static_cast<double>(odometry.map_memory_bytes()), 2.1 * static_cast<double>(bytes_early));
}

}  // namespace
}  // namespace tumble
