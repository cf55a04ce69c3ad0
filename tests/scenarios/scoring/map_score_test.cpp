// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/perfect_estimate.hpp"
#include "sim/lidar/surface.hpp"
#include "tests/scenarios/testing.hpp"

// the test compares maps with the true surface of an empty square room: its floor is at z = 0
namespace tumble::scenarios {
namespace {

using testing::perfect_estimate;
using testing::scores;

sim::ResolvedSituation empty_room() {
  sim::Situation situation;
  situation.scenario = "test";
  situation.duration_s = 6.0;
  situation.world.type = "floor";
  situation.world.values.set("room_half_m", testing::kRoomHalfM);
  situation.world.values.set("wall_height_m", testing::kRoomHeightM);
  situation.world.values.set("pillar_count", 0.0);
  situation.world.values.set("box_count", 0.0);
  situation.robot.type = "sphere";
  situation.motion.type = "hand_roll";
  return sim::resolve(situation);
}

const sim::Surface& surface() {
  static const sim::Surface room(sim::BuiltSituation(empty_room(), test::source_dir() / "models"));
  return room;
}

std::vector<MapPoint> floor_points(float height_m) {
  std::vector<MapPoint> points;
  for (float x = -3.0f; x <= 3.0f; x += 0.25f) {
    for (float y = -3.0f; y <= 3.0f; y += 0.25f) {
      MapPoint point;
      point.position_W_m = {x, y, height_m};
      points.push_back(point);
    }
  }
  return points;
}

TEST(MapScores, TheTrueHitsAreAWholeMap) {
  Estimate estimate = perfect_estimate(rig());
  testing::move_world(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(-2.0, Eigen::Vector3d::UnitZ()), estimate);
  const auto values = scores(Kind::slam, estimate, rig(), &surface());
  EXPECT_EQ(values.at("map_overlap"), 1.0);
  EXPECT_EQ(values.at("map_coverage"), 1.0);
  EXPECT_EQ(values.at("map_failed"), 0.0);
}

TEST(MapScores, TheToleranceIsAQuarterMetre) {
  Estimate estimate = perfect_estimate(rig());
  estimate.map = floor_points(0.24f);
  EXPECT_EQ(scores(Kind::slam, estimate, rig(), &surface()).at("map_overlap"), 1.0);
  estimate.map = floor_points(0.26f);
  const auto values = scores(Kind::slam, estimate, rig(), &surface());
  EXPECT_EQ(values.at("map_overlap"), 0.0);
  EXPECT_EQ(values.at("map_failed"), 1.0);
}

TEST(MapScores, TheFineToleranceIsTenCentimetres) {
  Estimate estimate = perfect_estimate(rig());
  for (const float height_m : {0.099f, 0.101f, 0.249f}) {
    estimate.map = floor_points(height_m);
    const auto values = scores(Kind::slam, estimate, rig(), &surface());
    EXPECT_EQ(values.at("map_overlap_0_10"), height_m < 0.1f ? 1.0 : 0.0) << height_m;
    EXPECT_EQ(values.at("map_overlap"), 1.0) << height_m;
  }
}

// the shares of overlap are 1 for both maps
TEST(MapScores, TheMeanErrorSeesWhatTheTolerancesDoNot) {
  Estimate estimate = perfect_estimate(rig());
  for (const float height_m : {0.01f, 0.05f}) {
    estimate.map = floor_points(height_m);
    EXPECT_NEAR(scores(Kind::slam, estimate, rig(), &surface()).at("map_error_mean_m"), height_m, 1e-5);
  }
  estimate.map = floor_points(0.0f);
  estimate.map.resize(100);
  estimate.map.front().position_W_m = {0.0f, 0.0f, 1.5f};
  EXPECT_NEAR(scores(Kind::slam, estimate, rig(), &surface()).at("map_error_mean_m"), 0.005, 1e-5) << "capped at 0.5 m";
}

TEST(MapScores, PointsThatWereDrawnTwiceAreNotUnique) {
  Estimate estimate = perfect_estimate(rig());
  estimate.map = floor_points(0.0f);
  EXPECT_EQ(scores(Kind::slam, estimate, rig(), &surface()).at("map_unique_share"), 1.0);
  const std::vector<MapPoint> once = estimate.map;
  estimate.map.insert(estimate.map.end(), once.begin(), once.end());
  EXPECT_EQ(scores(Kind::slam, estimate, rig(), &surface()).at("map_unique_share"), 0.5);
}

TEST(MapScores, AMapFailsBeyondFifteenPercentOutliers) {
  for (const auto& [outliers, failed] : std::vector<std::pair<std::size_t, double>>{{14, 0.0}, {16, 1.0}}) {
    Estimate estimate = perfect_estimate(rig());
    const std::size_t points = estimate.map.size();
    const std::size_t off = outliers * points / 100;
    for (std::size_t k = 0; k < off; ++k) estimate.map[k * points / off].position_W_m = {0.0f, 0.0f, 1.0f};
    const auto values = scores(Kind::slam, estimate, rig(), &surface());
    EXPECT_NEAR(values.at("map_overlap"), 1.0 - static_cast<double>(off) / static_cast<double>(points), 1e-12);
    EXPECT_EQ(values.at("map_failed"), failed);
  }
}

TEST(MapScores, PointsThatAreNotNumbersLieOffTheSurface) {
  Estimate estimate = perfect_estimate(rig());
  estimate.map = floor_points(0.0f);
  estimate.map.resize(100);
  for (std::size_t k = 0; k < 50; ++k) estimate.map[k].position_W_m.x() = std::nanf("");
  EXPECT_NEAR(scores(Kind::slam, estimate, rig(), &surface()).at("map_overlap"), 0.5, 1e-12);
  EXPECT_EQ(scores(Kind::slam, estimate, rig(), &surface()).at("map_error_mean_m"), 0.5) << "no mean of a part";
}

TEST(MapScores, CoverageIsTheShareOfWhatWasSeen) {
  Estimate estimate = perfect_estimate(rig());
  // the map omits the half of the room with y < 0
  std::erase_if(estimate.map, [](const MapPoint& point) { return point.position_W_m.y() < 0.0f; });
  const double coverage = scores(Kind::slam, estimate, rig(), &surface()).at("map_coverage");
  EXPECT_GT(coverage, 0.4);
  EXPECT_LT(coverage, 0.65);
}

TEST(MapScores, AMapOfLessThanHalfOfWhatWasSeenFails) {
  for (const float from_m : {-1.0f, 1.5f}) {
    Estimate estimate = perfect_estimate(rig());
    std::erase_if(estimate.map, [&](const MapPoint& point) { return point.position_W_m.y() < from_m; });
    const auto values = scores(Kind::slam, estimate, rig(), &surface());
    EXPECT_EQ(values.at("map_overlap"), 1.0);
    EXPECT_EQ(values.at("map_coverage") < 0.5, from_m > 0.0f);
    EXPECT_EQ(values.at("map_failed"), from_m > 0.0f ? 1.0 : 0.0);
  }
}

TEST(MapScores, NoMapIsAFailedMapAndNoSurfaceNoVerdict) {
  Estimate estimate = perfect_estimate(rig());
  estimate.map.clear();
  const auto values = scores(Kind::slam, estimate, rig(), &surface());
  EXPECT_EQ(values.at("map_failed"), 1.0);
  EXPECT_FALSE(values.contains("map_overlap"));
  estimate.sweeps.clear();
  EXPECT_FALSE(scores(Kind::slam, estimate, rig(), &surface()).contains("map_failed")) << "a trajectory alone";
  EXPECT_FALSE(scores(Kind::slam, perfect_estimate(rig()), rig()).contains("map_failed"));
}

}  // namespace
}  // namespace tumble::scenarios
