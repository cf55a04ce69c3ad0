// SPDX-License-Identifier: BSD-3-Clause
// Tests TumblingOdometry in the map of an earlier run.
#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {
namespace {

TumblingOdometry::Params rig_params() {
  TumblingOdometry::Params params;
  params.lever_arm_I_m = {-0.02, -0.08, 0.05};
  params.T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  params.T_IL.linear() = so3::exp({0.0, 0.0, -0.5 * std::numbers::pi}).toRotationMatrix();
  return params;
}

/// Returns a slow rotation with an oscillating translation of metres.
test::Motion motion(double swing) {
  test::Motion out;
  out.rest_s = 0.6;
  out.spin_rad_s = 3.0;
  out.second_spin_rad_s = 1.0;
  out.swing = swing;
  return out;
}

struct RoomRun {
  explicit RoomRun(double swing) : moves(motion(swing)), imu(test::make_imu(moves, 4.0)), odometry(rig_params()) {}

  /// Adds the data of the sweeps from..to-1 with time stamps that are `ahead_ns` late, and stores the newest report.
  /// RoomRun drops data that the odometry rejects because of their order.
  void feed(int from, int to, TimeNs ahead_ns = 0) {
    const auto added = [](const Status& status) { return status.ok() || status.error_code == ErrorCode::time_order; };
    for (int sweep = from; sweep < to; ++sweep) {
      for (int k = sweep * test::kSamplesPerSweep; k < (sweep + 1) * test::kSamplesPerSweep; ++k) {
        ImuSample sample = imu[static_cast<std::size_t>(k)];
        sample.time_ns += ahead_ns;
        ASSERT_TRUE(added(odometry.add_imu(sample)));
      }
      const std::vector<LidarPoint> points = test::make_sweep(test::Room::box_with_pillars(), moves, rig_params().T_IL,
                                                              sweep, test::kRoomNoise_m, test::kHalfColumns);
      const TimeNs start_ns = sweep * test::kSweep_ns + ahead_ns;
      ASSERT_TRUE(added(odometry.add_sweep(start_ns, start_ns + test::kSweep_ns, points)));
      while (std::optional<TumblingOdometry::Sweep> done = odometry.take()) newest = std::move(done->result);
    }
  }
  double error_in_room_m(const Eigen::Isometry3d& T_MR = Eigen::Isometry3d::Identity()) const {
    return (newest.pose.position_W_m - T_MR * moves.p_m(1e-9 * static_cast<double>(newest.pose.time_ns))).norm();
  }

  test::Motion moves;
  std::vector<ImuSample> imu;
  TumblingOdometry odometry;
  SweepResult newest;
};

/// Returns the map of a run, in the frame of the room.
const std::vector<MapPoint>& map_of_first_run() {
  static const std::vector<MapPoint> points = [] {
    RoomRun run(1.0);
    run.feed(0, 25);
    return run.odometry.mapper().map();
  }();
  return points;
}

TEST(PriorMapRun, HealthReportsThatARunIsNotLocalisedUntilItIs) {
  RoomRun run(-0.7);
  ASSERT_TRUE(run.odometry.set_prior_map({.points = map_of_first_run()}).ok());
  run.feed(0, 5);
  EXPECT_NE(std::string(run.odometry.health().worst_status().field).find("too few to localise the run"),
            std::string::npos);
  EXPECT_FALSE(run.newest.in_prior_map);
  run.feed(5, 30);
  EXPECT_TRUE(run.odometry.health().ok()) << run.odometry.health().worst_message();
  EXPECT_TRUE(run.newest.in_prior_map);
  EXPECT_LT(run.error_in_room_m(), 0.1);
  EXPECT_FALSE(run.odometry.first_seconds_reprocessing_applied());
}

TEST(PriorMapRun, ResetKeepsTheMapAndLocalisesAgain) {
  RoomRun run(-0.7);
  ASSERT_TRUE(run.odometry.set_prior_map({.points = map_of_first_run()}).ok());
  run.odometry.reset();
  EXPECT_NE(run.odometry.mapper().prior_map(), nullptr);
  run.odometry.reset(Eigen::Isometry3d::Identity());
  EXPECT_FALSE(run.odometry.mapper().check_localised().ok());
  run.feed(0, 25);
  EXPECT_TRUE(run.newest.in_prior_map);
  EXPECT_LT(run.error_in_room_m(), 0.1);
}

TEST(PriorMapRun, AClockStepBeforeLocalisationStartsTheSearchAgain) {
  RoomRun run(-0.7);
  ASSERT_TRUE(run.odometry.set_prior_map({.points = map_of_first_run()}).ok());
  run.feed(0, 2, 20'000'000'000);
  ASSERT_FALSE(run.odometry.mapper().check_localised().ok());
  run.feed(2, 30);
  EXPECT_EQ(run.odometry.restart_count(), 1U);
  EXPECT_TRUE(run.newest.in_prior_map);
  EXPECT_LT(run.error_in_room_m(), 0.1);
}

/// Returns the pose of the room in the frame of the saved map.
Eigen::Isometry3d elsewhere() {
  return Eigen::Isometry3d(Eigen::Translation3d(30.0, -4.0, 2.0) * Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
}

TEST(SavedRun, ANewObjectLocalisesInTheSavedMapAtTheSavedPose) {
  RoomRun before(-0.7), after(-0.7);
  before.odometry.reset(elsewhere());
  before.feed(0, 5);  // rests
  std::optional<PoseState> last;
  const Status loaded = after.odometry.load(before.odometry.save(), &last);
  ASSERT_TRUE(loaded.ok()) << loaded.message();
  ASSERT_TRUE(last);
  EXPECT_LT((last->position_W_m - elsewhere().translation()).norm(), 0.05);
  EXPECT_FALSE(after.odometry.mapper().check_localised().ok());
  after.feed(0, 30);
  EXPECT_TRUE(after.newest.in_prior_map);
  EXPECT_LT(after.error_in_room_m(elsewhere()), 0.1);
}

TEST(SavedRun, ARunSavedInMotionKeepsItsMap) {
  RoomRun before(1.0), after(-0.7), again(-0.7);
  before.odometry.reset(elsewhere());
  before.feed(0, 25);
  std::optional<PoseState> last;
  ASSERT_TRUE(after.odometry.load(before.odometry.save(), &last).ok());
  ASSERT_TRUE(last);
  EXPECT_LT((last->position_W_m - elsewhere() * before.moves.p_m(1e-9 * static_cast<double>(last->time_ns))).norm(),
            0.1);
  EXPECT_EQ(after.odometry.mapper().prior_map()->points.size(), before.odometry.mapper().map().size());
  after.odometry.reset(elsewhere());  // the robot was carried back
  after.feed(0, 5);
  EXPECT_FALSE(after.newest.in_prior_map) << "else this tests nothing";
  // a run that is not yet localised saves the map that it was given
  ASSERT_TRUE(again.odometry.load(after.odometry.save()).ok());
  EXPECT_EQ(again.odometry.mapper().prior_map()->points.size(), before.odometry.mapper().map().size());
  for (RoomRun* run : {&after, &again}) {
    run->feed(run == &after ? 5 : 0, 25);
    EXPECT_TRUE(run->newest.in_prior_map);
    EXPECT_LT(run->error_in_room_m(elsewhere()), 0.1);
  }
}

TEST(SavedRun, AConstantMapStaysConstant) {
  RoomRun before(-0.7), after(-0.7);
  ASSERT_TRUE(before.odometry.set_prior_map({.points = map_of_first_run(), .extend = false}).ok());
  before.feed(0, 25);
  ASSERT_TRUE(before.newest.in_prior_map);
  ASSERT_TRUE(after.odometry.load(before.odometry.save()).ok());
  EXPECT_FALSE(after.odometry.mapper().prior_map()->extend);
  EXPECT_EQ(after.odometry.mapper().prior_map()->points.size(), map_of_first_run().size());
}

}  // namespace
}  // namespace tumble
