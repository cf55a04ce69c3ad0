// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/src/mapping/sweep_points.hpp"

#include "tests/estimator/mapping/room_tumble.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

constexpr RangeNoise kNoise{0.02, 0.0015};
// at a range of 15 m, returns 0.4 deg apart belong to one surface at 10 deg up to this difference
constexpr float kNoticeable_m = 0.6f;

std::vector<SweepPoint> selected(const std::vector<LidarPoint>& given) {
  std::vector<SweepPoint> points;
  PointSelectionBounds bounds;
  bounds.own_body_L.setEmpty();
  select_points(given, bounds, Eigen::Isometry3d::Identity(), 0.0, points);
  return points;
}

/// Replaces one return in twenty by a random range up to 15 m along its beam; `moved_m` receives the displacements.
std::vector<LidarPoint> dusty(std::vector<LidarPoint> points, std::uint64_t seed, std::vector<float>* moved_m) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint64_t counter = (seed << 24) + 2 * k;
    const float range_m = points[k].position_L_m.norm();
    float to_m = range_m;
    if (test::uniform(counter) < 0.05) to_m = static_cast<float>(0.7 + 15.0 * test::uniform(counter + 1));
    points[k].position_L_m *= to_m / range_m;
    if (moved_m != nullptr) moved_m->push_back(std::abs(to_m - range_m));
  }
  return points;
}

/// Returns a ring with `step_rad` between returns, at the given ranges; 0 is a miss.
std::vector<SweepPoint> ring(const std::vector<float>& ranges_m, double step_rad) {
  std::vector<LidarPoint> points;
  for (std::size_t k = 0; k < ranges_m.size(); ++k) {
    const double azimuth = step_rad * static_cast<double>(k);
    if (ranges_m[k] == 0.0f) continue;
    LidarPoint& point = points.emplace_back();
    point.position_L_m = ranges_m[k] * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0).cast<float>();
    point.offset_ns = static_cast<std::uint32_t>(50'000 * k);
  }
  return selected(points);
}

std::vector<float> ranges(const std::vector<SweepPoint>& points) {
  std::vector<float> out;
  for (const SweepPoint& point : points) out.push_back(std::round(1e3f * point.range_m) / 1e3f);
  return out;
}

TEST(LoneReturns, GoAndTheirNeighboursStay) {
  LoneReturns lone;
  std::vector<float> wall(40, 8.0f);
  wall[20] = 5.0f;
  std::vector<SweepPoint> points = ring(wall, 0.004);
  EXPECT_EQ(lone.drop_isolated_returns(kNoise, points), 1u);
  ASSERT_EQ(points.size(), 39u);
  for (const SweepPoint& point : points) EXPECT_NEAR(point.range_m, 8.0f, 1e-3f);
}

/// An object hit by two beams is a surface; so are both sides of an edge.
TEST(LoneReturns, ThinThingsAndEdgesStay) {
  LoneReturns lone;
  std::vector<float> scene(40, 8.0f);
  scene[20] = scene[21] = 5.0f;
  for (std::size_t k = 30; k < 40; ++k) scene[k] = 20.0f;
  std::vector<SweepPoint> points = ring(scene, 0.004);
  EXPECT_EQ(lone.drop_isolated_returns(kNoise, points), 0u);
  EXPECT_EQ(points.size(), 40u);
}

/// Ground 0.5 m below an upright ring, 6 to 10 m away, is seen at 3 to 5 degrees: its returns differ in range more than
/// a surface at 10 degrees, but each is between its neighbours. A return out of line is removed.
TEST(LoneReturns, GroundAtAGrazingAngleStays) {
  LoneReturns lone;
  std::vector<float> scene;
  for (int k = 0; k < 11; ++k) scene.push_back(static_cast<float>(0.5 / std::sin(0.08 - 0.003 * k)));
  std::vector<SweepPoint> points = ring(scene, 0.003);
  // the ends of the row have neighbours on one side only
  EXPECT_LE(lone.drop_isolated_returns(kNoise, points), 2u);
  scene[5] -= 1.5f;
  points = ring(scene, 0.003);
  lone.drop_isolated_returns(kNoise, points);
  const std::vector<float> left = ranges(points);
  EXPECT_EQ(std::count(left.begin(), left.end(), std::round(1e3f * scene[5]) / 1e3f), 0);
}

TEST(LoneReturns, AReturnAmidMissesGoes) {
  LoneReturns lone;
  std::vector<float> sky(60, 0.0f);
  for (std::size_t k = 0; k < 20; ++k) sky[k] = 8.0f;
  sky[40] = 8.0f;
  std::vector<SweepPoint> points = ring(sky, 0.004);
  EXPECT_EQ(lone.drop_isolated_returns(kNoise, points), 1u);
}

/// If successive returns are 45 degrees apart, they cannot confirm each other.
TEST(LoneReturns, ASweepWithoutNeighboursKeepsAll) {
  LoneReturns lone;
  std::vector<float> scattered;
  for (int k = 0; k < 40; ++k) scattered.push_back(static_cast<float>(1.0 + 20.0 * test::uniform(k)));
  std::vector<SweepPoint> points = ring(scattered, 0.8);
  EXPECT_EQ(lone.drop_isolated_returns(kNoise, points), 0u);
  EXPECT_EQ(points.size(), 40u);
}

TEST(LoneReturns, OfATumbleInDustFewStayAndFewGoTooMany) {
  LoneReturns lone;
  std::size_t dust = 0, dust_left = 0, clean = 0, clean_left = 0;
  for (int sweep = 0; sweep < 10; ++sweep) {
    std::vector<float> moved_m;
    const std::vector<LidarPoint> given = dusty(test::room_tumble().sweeps[sweep], sweep, &moved_m);
    std::vector<SweepPoint> points = selected(given);
    lone.drop_isolated_returns(kNoise, points);
    std::set<std::pair<std::uint16_t, float>> left;
    for (const SweepPoint& point : points) left.insert({point.ring, point.sweep_time_s});
    for (std::size_t k = 0; k < given.size(); ++k) {
      const bool stays = left.contains({given[k].ring, static_cast<float>(seconds(given[k].offset_ns))});
      if (moved_m[k] > kNoticeable_m) ++dust, dust_left += stays;
      if (moved_m[k] < 1e-4f) ++clean, clean_left += stays;
    }
  }
  ASSERT_GT(dust, 5000u);
  EXPECT_LT(static_cast<double>(dust_left), 0.02 * static_cast<double>(dust));
  EXPECT_GT(static_cast<double>(clean_left), 0.99 * static_cast<double>(clean));
}

/// The map of a tumble in dust is on the surfaces.
TEST(LoneReturns, KeepDustOutOfTheMap) {
  LidarInertialOdometry odometry(test::rig_params());
  LidarInertialOdometry::SweepResult report;
  std::size_t alone = 0;
  for (int sweep = 0; sweep < 26; ++sweep) {
    test::feed_imu(odometry, sweep);
    const auto points = dusty(test::room_tumble().sweeps[static_cast<std::size_t>(sweep)], sweep, nullptr);
    ASSERT_TRUE(test::add_sweep(odometry, sweep, points, report).ok());
    alone += report.isolated_points_dropped;
  }
  EXPECT_LT(test::error_of(report.pose).m, 0.05);
  EXPECT_GT(alone, 10'000u);
  const std::vector<MapPoint> map = odometry.map();
  std::size_t near = 0;
  for (const MapPoint& point : map) {
    near += test::Room::box_with_pillars().distance(point.position_W_m.cast<double>()) < 0.25;
  }
  EXPECT_GT(static_cast<double>(near), 0.98 * static_cast<double>(map.size()));
}

}  // namespace
}  // namespace tumble
