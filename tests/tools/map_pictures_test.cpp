// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/map_pictures.hpp"

#include "tests/testing.hpp"
#include "tests/tools/replays.hpp"

namespace tumble::tools {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

const sim::Surface& surface() {
  static const sim::Surface room(testing::room());
  return room;
}

/// Returns a body that moves from the origin along x.
sim::Truth straight_path() {
  sim::Truth truth;
  truth.period_ns = 10'000'000;
  for (int k = 0; k <= 100; ++k) {
    truth.p_WB_m.emplace_back(0.01 * k, 0.0, 0.5);
    truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    truth.v_WB_m_s.emplace_back(1.0, 0.0, 0.0);
    truth.w_WB_B_rad_s.push_back(Eigen::Vector3d::Zero());
  }
  return truth;
}

/// Returns the truth in a turned and moved world, with a map of points at two heights there.
scenarios::Estimate estimate_elsewhere(const sim::Truth& truth) {
  const Isometry3d T_VW(Eigen::Translation3d(3, -4, 1) * Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()));
  scenarios::Estimate estimate;
  estimate.frame = scenarios::Frame::body;
  for (std::size_t k = 0; k < truth.p_WB_m.size(); ++k) {
    PoseState pose;
    pose.time_ns = static_cast<std::int64_t>(k) * truth.period_ns;
    pose.position_W_m = T_VW * truth.p_WB_m[k];
    pose.orientation_W = Quaterniond(T_VW.linear()) * truth.q_WB[k];
    estimate.poses.push_back(pose);
  }
  for (const double height_m : {0.0, 0.0, 0.0, 0.4}) {
    MapPoint point;
    point.position_W_m = (T_VW * Vector3d(1.0, 0.5, height_m)).cast<float>();
    estimate.map.push_back(point);
  }
  MapPoint lost;
  lost.position_W_m.setConstant(std::numeric_limits<float>::quiet_NaN());
  estimate.map.push_back(lost);
  return estimate;
}

Rgb pixel(const sim::Picture& picture, int column, int row) {
  const std::size_t at = 3 * static_cast<std::size_t>(row * picture.width + column);
  return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

int count(const sim::Picture& picture, const Rgb& colour, int left, int right, int bottom) {
  int found = 0;
  for (int row = 0; row < bottom; ++row) {
    for (int column = left; column < right; ++column) found += pixel(picture, column, row) == colour ? 1 : 0;
  }
  return found;
}

TEST(ErrorMap, IsComparedWithTheTrueSurfaceInTheTruthsWorld) {
  const sim::Truth truth = straight_path();
  const ErrorMap map = map_by_error("slam/test", estimate_elsewhere(truth), truth, surface());
  ASSERT_EQ(map.points_W_m.size(), 4u) << "the point that is none is left out";
  EXPECT_NEAR((map.points_W_m[3] - Vector3f(1.0f, 0.5f, 0.4f)).norm(), 0.0f, 1e-5f);
  EXPECT_NEAR(map.error_m[0], 0.0f, 1e-5f);
  EXPECT_NEAR(map.error_m[3], 0.4f, 1e-5f);
  EXPECT_NEAR(map.share_within(0.1f), 0.75, 1e-12);
  // the negative controls are no map, and a map without poses to place it
  scenarios::Estimate empty = estimate_elsewhere(truth);
  empty.map.clear();
  EXPECT_TRUE(map_by_error("a", empty, truth, surface()).points_W_m.empty());
  scenarios::Estimate adrift = estimate_elsewhere(truth);
  adrift.poses.clear();
  EXPECT_TRUE(map_by_error("a", adrift, truth, surface()).points_W_m.empty());
}

TEST(ErrorColour, GoesFromBlueToRed) {
  const Rgb exact = error_colour(0.0f), far = error_colour(kMapErrorMax_m);
  EXPECT_GT(exact[2], exact[0]);
  EXPECT_GT(far[0], far[2]);
  EXPECT_EQ(error_colour(10.0f), far);
  EXPECT_NE(error_colour(0.1f), error_colour(0.25f));
}

TEST(MapPicture, ShowsEachMapInItsPanelNearerPointsInFront) {
  const sim::Truth truth = straight_path();
  // the middle of the path is in the middle of the panel
  ErrorMap good, bad;
  good.points_W_m = {{0.5f, 0.0f, 0.5f}};
  good.error_m = {0.0f};
  bad.points_W_m = {{0.5f, 0.0f, 0.5f}};
  bad.error_m = {kMapErrorMax_m};
  const int width = 120, height = 90;
  const sim::Picture picture = map_picture({good, bad}, truth, width, height);
  ASSERT_EQ(picture.rgb.size(), 3u * static_cast<std::size_t>(picture.width * picture.height));
  EXPECT_EQ(pixel(picture, width / 2, height / 2), error_colour(0.0f));
  EXPECT_EQ(count(picture, error_colour(0.0f), 0, width, height), 4) << "two by two pixels";
  EXPECT_EQ(count(picture, error_colour(kMapErrorMax_m), 0, width, height), 0);
  EXPECT_EQ(count(picture, error_colour(kMapErrorMax_m), width, picture.width, height), 4);

  // in one map, a point above another one hides it when seen from above, whichever comes first
  ErrorMap both = bad;
  both.points_W_m.emplace_back(0.5f, 0.0f, 0.5f);
  both.error_m.push_back(0.0f);
  EXPECT_EQ(count(map_picture({both}, truth, width, height), error_colour(kMapErrorMax_m), 0, width, height), 4)
      << "of two at one place the first";
  EXPECT_THROW(map_picture({}, truth, width, height), std::invalid_argument);
  EXPECT_THROW(map_picture({good}, sim::Truth(), width, height), std::invalid_argument);
}

}  // namespace
}  // namespace tumble::tools
