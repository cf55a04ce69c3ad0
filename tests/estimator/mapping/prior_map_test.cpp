// SPDX-License-Identifier: BSD-3-Clause
// Tests localisation in the map of an earlier run.
#include "tumble/mapping/types.hpp"

#include "tests/estimator/mapping/room_rig.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using test::Room;
using test::RoomRig;
using test::true_params;

constexpr int kMapped = 14;     // sweeps of the run that makes the map
constexpr int kLocalised = 14;  // sweeps within which a run must be localised: 1.1 s after the start of its motion

/// Returns the pose of the prior map's frame, rotated and translated, so that no start fits by luck.
Eigen::Isometry3d T_MW(double yaw_rad = 2.0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(7.0, -12.0, 3.0);
  return T;
}

std::vector<MapPoint> moved(std::vector<MapPoint> points, const Eigen::Isometry3d& T) {
  for (MapPoint& point : points) {
    point.position_W_m = T.cast<float>() * point.position_W_m;
    point.normal_W = T.linear().cast<float>() * point.normal_W;
  }
  return points;
}

/// Returns the map of a run in a room, in its frame M.
const std::vector<MapPoint>& map_of_pillars() {
  static const std::vector<MapPoint> points = [] {
    RoomRig rig(true_params());
    rig.run(0, kMapped);
    return moved(rig.odometry.map(), T_MW());
  }();
  return points;
}

/// Returns a motion that differs from that of the map.
test::Motion second_motion() {
  test::Motion motion = test::slower();
  motion.swing = -0.8;
  motion.second_spin_rad_s = -2.5;
  return motion;
}

double error_in_map_m(const RoomRig& rig) {
  const double t = 1e-9 * static_cast<double>(rig.report.pose.time_ns);
  return (rig.report.pose.position_W_m - T_MW() * rig.motion.p_m(t)).norm();
}

/// Runs until the run is localised, at most to sweep `last`, and returns the number of sweeps.
int run_until_localised(RoomRig& rig, int last = kLocalised) {
  int k = 0;
  while (k < last && !rig.odometry.check_localised().ok()) {
    rig.run(k, k + 1);
    ++k;
  }
  return k;
}

TEST(PriorMap, ARunIsLocalisedWithoutAPose) {
  RoomRig rig(true_params(), second_motion());
  ASSERT_TRUE(rig.odometry.set_prior_map({.points = map_of_pillars()}).ok());
  EXPECT_EQ(rig.odometry.check_localised().error_code, ErrorCode::degenerate);
  const int sweeps = run_until_localised(rig);
  ASSERT_TRUE(rig.odometry.check_localised().ok()) << rig.odometry.check_localised().message();
  EXPECT_FALSE(rig.report.in_prior_map);  // poses of the accepting sweep are still in the local frame
  EXPECT_LT(rig.error_m(), 0.06);

  for (int k = sweeps; k < sweeps + 8; ++k) {
    rig.run(k, k + 1);
    ASSERT_TRUE(rig.report.in_prior_map);
    ASSERT_EQ(rig.report.verdict, SweepVerdict::registered) << "sweep " << k;
    EXPECT_LT(error_in_map_m(rig), 0.06) << "sweep " << k;
    // 16.8 is the 99.9 % quantile of chi-square with three degrees of freedom, doubled because the covariance omits map
    // errors that both runs share
    const double t = 1e-9 * static_cast<double>(rig.report.pose.time_ns);
    const Eigen::Vector3d error = rig.report.pose.position_W_m - T_MW() * rig.motion.p_m(t);
    const Eigen::Matrix3d covariance = rig.report.pose.covariance.topLeftCorner<3, 3>();
    EXPECT_LT(error.dot(covariance.inverse() * error), 2.0 * 16.8) << "sweep " << k;
  }
}

TEST(PriorMap, EarlierPosesAreTransformedToTheFrameOfTheMap) {
  RoomRig rig(true_params(), second_motion());
  ASSERT_TRUE(rig.odometry.set_prior_map({.points = map_of_pillars()}).ok());
  std::vector<PoseState> poses;
  for (int k = 0; k < kLocalised && !rig.odometry.check_localised().ok(); ++k) {
    EXPECT_EQ(rig.odometry.convert_to_prior_map_frame(poses).error_code, ErrorCode::degenerate);
    rig.run(k, k + 1);
    poses.push_back(rig.report.pose);
  }
  ASSERT_TRUE(rig.odometry.convert_to_prior_map_frame(poses).ok());
  ASSERT_GT(poses.size(), 3u);
  for (const PoseState& pose : poses) {
    const double t = 1e-9 * static_cast<double>(pose.time_ns);
    const Eigen::Isometry3d expected = T_MW() * rig.motion.pose(t);
    const Eigen::Vector3d error = pose.position_W_m - expected.translation();
    EXPECT_LT(error.norm(), 0.06) << t;
    EXPECT_LT(pose.orientation_W.angularDistance(Eigen::Quaterniond(expected.linear())), 0.02) << t;
    const Eigen::Matrix3d covariance = pose.covariance.topLeftCorner<3, 3>();
    EXPECT_LT(error.dot(covariance.inverse() * error), 2.0 * 16.8) << t;
  }
}

TEST(PriorMap, AnApproximateOrAGivenPoseLimitsTheSearch) {
  for (const double error_m : {0.0, 1.5}) {
    RoomRig rig(true_params(), second_motion());
    PriorMap map{.points = map_of_pillars(), .start_T_MI = T_MW() * rig.motion.pose(0.0)};
    map.start_T_MI->translation() += error_m * Eigen::Vector3d(0.6, -0.8, 0.0);
    map.start_position_sigma_m = error_m;
    map.start_heading_sigma_rad = 0.1 * error_m;
    ASSERT_TRUE(rig.odometry.set_prior_map(map).ok());
    const int sweeps = run_until_localised(rig);
    ASSERT_TRUE(rig.odometry.check_localised().ok()) << error_m;
    rig.run(sweeps, sweeps + 2);
    EXPECT_TRUE(rig.report.in_prior_map);
    EXPECT_LT(error_in_map_m(rig), 0.06) << error_m;
  }
}

TEST(PriorMap, AWrongGivenPoseIsNotAccepted) {
  RoomRig rig(true_params(), second_motion());
  PriorMap map{.points = map_of_pillars(), .start_T_MI = T_MW() * rig.motion.pose(0.0)};
  map.start_T_MI->translation() += Eigen::Vector3d(6.0, 0.0, 0.0);
  ASSERT_TRUE(rig.odometry.set_prior_map(map).ok());
  run_until_localised(rig);
  EXPECT_EQ(rig.odometry.check_localised().error_code, ErrorCode::degenerate);
}

TEST(PriorMap, AMapOfAnotherPlaceIsNotAccepted) {
  Room other = Room::box_with_pillars();
  for (std::size_t k = 0; k < other.pillars.size(); ++k)
    other.pillars[k].centre_m += 2.5 * Eigen::Vector2d(std::cos(2.0 * double(k)), std::sin(2.0 * double(k)));
  for (Room::Plane& plane : other.planes) plane.point_m.x() *= 1.2;
  RoomRig rig(true_params(), second_motion(), other);
  ASSERT_TRUE(rig.odometry.set_prior_map({.points = map_of_pillars()}).ok());
  run_until_localised(rig, 25);
  EXPECT_EQ(rig.odometry.check_localised().error_code, ErrorCode::degenerate);
  EXPECT_FALSE(rig.report.in_prior_map);
  EXPECT_LT(rig.error_m(), 0.06);  // in the local frame
}

TEST(PriorMap, TwoEqualPlacesAreAmbiguous) {
  RoomRig mapped(true_params(), test::slower(), Room::box());  // the room is symmetric under half a rotation
  mapped.run(0, kMapped);
  RoomRig rig(true_params(), second_motion(), Room::box());
  ASSERT_TRUE(rig.odometry.set_prior_map({.points = moved(mapped.odometry.map(), T_MW())}).ok());
  run_until_localised(rig, 25);
  EXPECT_EQ(rig.odometry.check_localised().error_code, ErrorCode::degenerate);
}

TEST(PriorMap, AFrozenMapStaysEqualAndAnExtendedMapGrows) {
  for (const bool extend : {false, true}) {
    RoomRig rig(true_params(), second_motion());
    ASSERT_TRUE(rig.odometry.set_prior_map({.points = map_of_pillars(), .extend = extend}).ok());
    const int sweeps = run_until_localised(rig);
    rig.run(sweeps, sweeps + 6);
    ASSERT_TRUE(rig.report.in_prior_map);
    const std::vector<MapPoint> map = rig.odometry.map();
    if (extend) {
      EXPECT_GT(map.size(), map_of_pillars().size());
      continue;
    }
    EXPECT_EQ(rig.report.map_points_added, 0u);
    ASSERT_EQ(map.size(), map_of_pillars().size());
    for (std::size_t k = 0; k < map.size(); ++k) {
      ASSERT_EQ(map[k].position_W_m, map_of_pillars()[k].position_W_m) << k;
      ASSERT_EQ(map[k].normal_W, map_of_pillars()[k].normal_W) << k;
      ASSERT_EQ(map[k].sigma_m, map_of_pillars()[k].sigma_m) << k;
    }
  }
}

TEST(PriorMap, LaterSweepsDoNotChangeEarlierReportsAndACopyContinues) {
  RoomRig rig(true_params(), second_motion());
  ASSERT_TRUE(rig.odometry.set_prior_map({.points = map_of_pillars()}).ok());
  rig.run(0, 8);
  RoomRig other(true_params(), second_motion());
  other.odometry = rig.odometry;
  for (int k = 8; k < kLocalised + 2; ++k) {
    rig.run(k, k + 1);
    other.run(k, k + 1);
    ASSERT_EQ(rig.report.pose.position_W_m, other.report.pose.position_W_m) << "sweep " << k;
    ASSERT_EQ(rig.report.in_prior_map, other.report.in_prior_map) << "sweep " << k;
  }
  EXPECT_TRUE(rig.report.in_prior_map);
}

TEST(PriorMap, PointsWithoutNormalsSuffice) {
  std::vector<Eigen::Vector3f> positions;
  for (const MapPoint& point : map_of_pillars()) positions.push_back(point.position_W_m);
  positions.push_back(Eigen::Vector3f::Constant(std::nanf("")));
  RoomRig rig(true_params(), second_motion());
  ASSERT_TRUE(rig.odometry.set_prior_map({.points = to_map_points(positions)}).ok());
  const int sweeps = run_until_localised(rig);
  ASSERT_TRUE(rig.odometry.check_localised().ok());
  rig.run(sweeps, sweeps + 2);
  EXPECT_LT(error_in_map_m(rig), 0.06);
}

TEST(PriorMap, UnusableMapsAreRefused) {
  RoomRig rig(true_params());
  EXPECT_EQ(rig.odometry.set_prior_map({}).error_code, ErrorCode::insufficient_data);
  PriorMap map{.points = map_of_pillars()};
  map.points[5].normal_W *= 2.0f;
  EXPECT_EQ(rig.odometry.set_prior_map(map).error_code, ErrorCode::out_of_range);
  map.points[5] = {Eigen::Vector3f::Constant(std::nanf("")), Eigen::Vector3f::UnitZ(), 0.1f};
  EXPECT_EQ(rig.odometry.set_prior_map(map).error_code, ErrorCode::non_finite);
  map.points = map_of_pillars();
  map.start_position_sigma_m = -1.0;
  EXPECT_EQ(rig.odometry.set_prior_map(map).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(rig.odometry.prior_map(), nullptr);
  EXPECT_TRUE(rig.odometry.check_localised().ok());
  rig.run(0, 1);
  EXPECT_EQ(rig.odometry.set_prior_map({.points = map_of_pillars()}).error_code, ErrorCode::time_order);
}

}  // namespace
}  // namespace tumble
