// SPDX-License-Identifier: BSD-3-Clause
// Tests a relocalisation that later sweeps confirm, or that is reverted with all inserted points.
#include "estimator/src/mapping/odometry_impl.hpp"
#include "tests/estimator/mapping/room_rig.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using test::RoomRig;
using test::true_params;

constexpr int kCovered = 20, kSeesAgain = 35;  // number of sweeps without points; first sweep with points

/// Returns the room as seen from another position: the sweep fits the map completely where the sensor is not.
std::vector<LidarPoint> seen_from_elsewhere(const RoomRig& rig, int sweep, double shift_m) {
  test::Room room = rig.room;
  for (test::Room::Plane& plane : room.planes) plane.point_m.x() -= shift_m;
  for (test::Room::Pillar& pillar : room.pillars) pillar.centre_m.x() -= shift_m;
  return test::make_sweep(room, rig.motion, true_params().T_IL, sweep, test::kRoomNoise_m, test::kHalfColumns);
}

/// Returns points at random ranges, which fit nothing.
std::vector<LidarPoint> of_no_room(const RoomRig& rig, int sweep) {
  std::vector<LidarPoint> points = rig.points(sweep);
  std::uint64_t counter = 0;
  for (LidarPoint& point : points)
    point.position_L_m *= static_cast<float>((1.0 + 15.0 * test::uniform(++counter)) / point.position_L_m.norm());
  return points;
}

/// Tracks, is covered, and then relocalises with a pose error of `shift_m`.
void find_again(RoomRig& rig, double shift_m) {
  rig.run(0, kCovered);
  ASSERT_EQ(rig.report.verdict, SweepVerdict::registered);
  for (int k = kCovered; k < kSeesAgain; ++k) {
    rig.feed_imu(k, {0.02, -0.02, 0.02});
    ASSERT_EQ(rig.sweep(k, {}).error_code, ErrorCode::empty);
  }
  rig.feed_imu(kSeesAgain);
  ASSERT_TRUE(rig.sweep(kSeesAgain, seen_from_elsewhere(rig, kSeesAgain, shift_m)).ok());
}

constexpr double kElsewhere_m = 0.8;

TEST(Relocalised, APlaceThatIsNoneIsTakenBackWithWhatItDrew) {
  RoomRig rig(true_params());
  find_again(rig, kElsewhere_m);
  ASSERT_NE(rig.report.verdict, SweepVerdict::rejected);
  EXPECT_TRUE(rig.report.relocalisation_unconfirmed);
  EXPECT_GT(rig.error_m(), 0.5);
  const std::size_t drawn = rig.report.map_points_added, with_it = rig.odometry.map().size();
  ASSERT_GT(drawn, 0u);

  rig.feed_imu(kSeesAgain + 1);
  ASSERT_TRUE(rig.sweep(kSeesAgain + 1, of_no_room(rig, kSeesAgain + 1)).ok());
  EXPECT_EQ(rig.report.verdict, SweepVerdict::rejected);
  EXPECT_EQ(rig.report.consecutive_rejected_sweeps,
            kSeesAgain + 1 - kCovered + 1);  // the sweeps before, the relocalised sweep and the current sweep
  EXPECT_FALSE(rig.report.relocalisation_unconfirmed);
  EXPECT_EQ(rig.odometry.map().size(), with_it - drawn + rig.report.map_points_added);
  const double sigma_m = std::sqrt(rig.report.pose.covariance.topLeftCorner<3, 3>().trace());
  EXPECT_LT(rig.error_m(), 3.0 * sigma_m);  // the stated deviation is that of a tracking failure

  rig.run(kSeesAgain + 2, kSeesAgain + 8);
  EXPECT_EQ(rig.report.verdict, SweepVerdict::registered);
  EXPECT_FALSE(rig.report.relocalisation_unconfirmed);
  EXPECT_LT(rig.error_m(), 0.06);
}

TEST(Relocalised, OnePlaceThatTwoSweepsBearOutStands) {
  RoomRig rig(true_params());
  find_again(rig, kElsewhere_m);
  ASSERT_TRUE(rig.report.relocalisation_unconfirmed);
  for (const bool relocalisation_unconfirmed : {true, false}) {
    const int k = relocalisation_unconfirmed ? kSeesAgain + 1 : kSeesAgain + 2;
    rig.feed_imu(k);
    ASSERT_TRUE(rig.sweep(k, seen_from_elsewhere(rig, k, kElsewhere_m)).ok());
    EXPECT_EQ(rig.report.relocalisation_unconfirmed, relocalisation_unconfirmed);
    EXPECT_EQ(rig.report.consecutive_rejected_sweeps, 0);
  }
  // a confirmed relocalisation is not reverted by a single sweep
  rig.feed_imu(kSeesAgain + 3);
  ASSERT_TRUE(rig.sweep(kSeesAgain + 3, of_no_room(rig, kSeesAgain + 3)).ok());
  EXPECT_EQ(rig.report.consecutive_rejected_sweeps, 1);
  EXPECT_GT(rig.error_m(), 0.5);
}

TEST(Relocalised, ARelocalisationThatInertiaConfirmsIsAcceptedAtOnce) {
  RoomRig rig(true_params());
  rig.run(0, kCovered);
  rig.feed_imu(kCovered);
  ASSERT_EQ(rig.sweep(kCovered, {}).error_code, ErrorCode::empty);
  rig.run(kCovered + 1, kCovered + 2);
  EXPECT_EQ(rig.report.verdict, SweepVerdict::registered);
  EXPECT_FALSE(rig.report.relocalisation_unconfirmed);
  EXPECT_LT(rig.error_m(), 0.05);
}

TEST(Relocalised, ACopyContinuesWithTheSameBits) {
  RoomRig rig(true_params());
  find_again(rig, kElsewhere_m);
  ASSERT_TRUE(rig.report.relocalisation_unconfirmed);
  RoomRig again(true_params());
  again.odometry = rig.odometry;
  for (RoomRig* one : {&rig, &again}) {
    one->feed_imu(kSeesAgain + 1);
    ASSERT_TRUE(one->sweep(kSeesAgain + 1, of_no_room(*one, kSeesAgain + 1)).ok());
    EXPECT_EQ(one->report.verdict, SweepVerdict::rejected);
  }
  EXPECT_EQ(rig.report.pose.position_W_m, again.report.pose.position_W_m);
  EXPECT_EQ(rig.report.pose.covariance, again.report.pose.covariance);
  EXPECT_EQ(rig.odometry.map().size(), again.odometry.map().size());
}

/// Gives access to the private implementation: an explicit instantiation may name private members.
template <auto kMember>
struct PrivateMember {
  friend LidarInertialOdometry::Impl& impl_of(LidarInertialOdometry& odometry) { return *(odometry.*kMember); }
};
LidarInertialOdometry::Impl& impl_of(LidarInertialOdometry& odometry);
template struct PrivateMember<&LidarInertialOdometry::impl_>;

// as after a motion of the alternative pose that could not be built
TEST(Relocalised, AnUnconfirmedPoseWithoutAnAlternativeIsConfirmedOrLost) {
  RoomRig rig(true_params());
  find_again(rig, kElsewhere_m);
  ASSERT_TRUE(rig.report.relocalisation_unconfirmed);
  ASSERT_TRUE(impl_of(rig.odometry).alternative.has_value());
  impl_of(rig.odometry).alternative.reset();
  RoomRig agrees(true_params());
  agrees.odometry = rig.odometry;
  for (const bool relocalisation_unconfirmed : {true, false}) {
    const int k = relocalisation_unconfirmed ? kSeesAgain + 1 : kSeesAgain + 2;
    agrees.feed_imu(k);
    ASSERT_TRUE(agrees.sweep(k, seen_from_elsewhere(agrees, k, kElsewhere_m)).ok());
    EXPECT_EQ(agrees.report.relocalisation_unconfirmed, relocalisation_unconfirmed);
    EXPECT_EQ(agrees.report.consecutive_rejected_sweeps, 0);
  }
  // without an alternative, the pose remains, and only the sweep is lost
  RoomRig contradicts(true_params());
  contradicts.odometry = rig.odometry;
  const std::size_t with_it = contradicts.odometry.map().size();
  contradicts.feed_imu(kSeesAgain + 1);
  ASSERT_TRUE(contradicts.sweep(kSeesAgain + 1, of_no_room(contradicts, kSeesAgain + 1)).ok());
  EXPECT_EQ(contradicts.report.verdict, SweepVerdict::rejected);
  EXPECT_EQ(contradicts.report.consecutive_rejected_sweeps, 1);
  EXPECT_FALSE(contradicts.report.relocalisation_unconfirmed);
  EXPECT_EQ(contradicts.odometry.map().size(), with_it);
}

/// Returns parameters with so small a map that whole sweeps leave it during motion.
OdometryParams keeps_little() {
  OdometryParams params = true_params();
  params.range_max_m = 40.0;
  params.expert.map.radius_m = 4.0;
  return params;
}

TEST(Relocalised, PruningWaitsUntilTheRelocalisationIsConfirmed) {
  RoomRig rig(true_params());
  find_again(rig, kElsewhere_m);
  ASSERT_TRUE(rig.report.relocalisation_unconfirmed);
  const std::size_t with_it = rig.odometry.map().size();
  const std::uint32_t inserted_from = impl_of(rig.odometry).alternative->first_inserted_sweep;

  // nothing is pruned during an unconfirmed relocalisation, because its points may be removed
  impl_of(rig.odometry).params = keeps_little();
  RoomRig agrees(keeps_little());
  agrees.odometry = rig.odometry;
  agrees.feed_imu(kSeesAgain + 1);
  ASSERT_TRUE(agrees.sweep(kSeesAgain + 1, seen_from_elsewhere(agrees, kSeesAgain + 1, kElsewhere_m)).ok());
  ASSERT_TRUE(agrees.report.relocalisation_unconfirmed);
  EXPECT_GE(agrees.odometry.map().size(), with_it);

  // contradicted: the map is pruned to fewer sweeps than before the relocalisation
  RoomRig contradicts(keeps_little());
  contradicts.odometry = rig.odometry;
  contradicts.feed_imu(kSeesAgain + 1);
  ASSERT_TRUE(contradicts.sweep(kSeesAgain + 1, of_no_room(contradicts, kSeesAgain + 1)).ok());
  ASSERT_EQ(contradicts.report.verdict, SweepVerdict::rejected);
  for (int k = kSeesAgain + 2; k < kSeesAgain + 10; ++k) {
    contradicts.feed_imu(k);
    ASSERT_EQ(contradicts.sweep(k, {}).error_code, ErrorCode::empty);
  }
  const LidarInertialOdometry::Impl& last = impl_of(contradicts.odometry);
  EXPECT_TRUE(last.alternative.has_value());
  EXPECT_LT(last.map.sweeps(), inserted_from);
}

}  // namespace
}  // namespace tumble
