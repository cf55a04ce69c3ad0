// SPDX-License-Identifier: BSD-3-Clause
// Tests the free space that a sweep observed, and the map without the removed points.
#include "estimator/src/mapping/local_map.hpp"
#include "tests/estimator/mapping/room_rig.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using mapping::FreeSpaceGrid;
using test::RoomRig;
using test::true_params;

constexpr float kWall_m = 8.0f;
const Eigen::Vector3f kFrom(1.0f, 2.0f, 0.5f);

/// Returns the view of a wall across x, seen from 8 m by returns half a degree apart, with a post of 0.2 m in front,
/// 0.5 m to the left.
FreeSpaceGrid before_a_wall(float moved_m) {
  FreeSpaceGrid sight;
  sight.start(kFrom, moved_m);
  for (float y = -4.0f; y <= 4.0f; y += 0.07f) {
    for (float z = -2.0f; z <= 2.0f; z += 0.07f) {
      const Eigen::Vector3f ray(kWall_m, y, z);
      sight.add(kFrom + (std::abs(0.5f * y - 0.5f) < 0.1f ? 0.5f : 1.0f) * ray);
    }
  }
  return sight;
}

TEST(FreeSpaceGrid, DistinguishesFreeSpaceFromSurfaces) {
  const FreeSpaceGrid sight = before_a_wall(0.0f);
  const auto verdict = [&](float x, float y, float z, float sigma_m = 0.01f) {
    return sight.verdict(kFrom + Eigen::Vector3f(x, y, z), sigma_m);
  };
  EXPECT_EQ(verdict(4.0f, -0.8f, 0.3f), FreeSpaceGrid::Verdict::free_space);
  EXPECT_EQ(verdict(kWall_m, -1.6f, 0.3f), FreeSpaceGrid::Verdict::occupied);
  EXPECT_EQ(verdict(4.0f, 0.5f, 0.3f), FreeSpaceGrid::Verdict::occupied);         // the post
  EXPECT_EQ(verdict(2.0f, 0.25f, 0.1f), FreeSpaceGrid::Verdict::free_space);      // before the post
  EXPECT_EQ(verdict(7.0f, 0.875f, 0.3f), FreeSpaceGrid::Verdict::unknown_space);  // behind it
  EXPECT_EQ(verdict(kWall_m + 3.0f, -1.6f, 0.3f), FreeSpaceGrid::Verdict::unknown_space);
  EXPECT_EQ(verdict(4.4f, 0.75f, 0.3f), FreeSpaceGrid::Verdict::unknown_space);  // by the post's edge
  EXPECT_EQ(verdict(-4.0f, 0.0f, 0.3f), FreeSpaceGrid::Verdict::unknown_space);  // nothing returned from there
  EXPECT_EQ(verdict(0.0f, 0.0f, 0.0f), FreeSpaceGrid::Verdict::unknown_space);
  EXPECT_EQ(verdict(7.0f, -1.4f, 0.3f), FreeSpaceGrid::Verdict::free_space);
  EXPECT_EQ(verdict(7.0f, -1.4f, 0.3f, 0.3f), FreeSpaceGrid::Verdict::occupied);  // who knows where it is
}

TEST(FreeSpaceGrid, SaysNothingOfWhatTheSensorPassed) {
  const FreeSpaceGrid sight = before_a_wall(0.5f);
  EXPECT_EQ(sight.verdict(kFrom + Eigen::Vector3f(4.0f, -0.8f, 0.3f), 0.01f), FreeSpaceGrid::Verdict::unknown_space);
  EXPECT_EQ(sight.verdict(kFrom + Eigen::Vector3f(6.0f, -1.2f, 0.3f), 0.01f), FreeSpaceGrid::Verdict::free_space);
}

constexpr int kLeaves = 8, kEnd = 32;  // sweeps
const test::Room::Pillar kVisitor{{7.0, -3.0}, 0.3};

/// Counts the map points on the visitor, away from the walls and the other pillars.
std::size_t on_the_visitor(const RoomRig& rig) {
  std::size_t count = 0;
  const test::Room alone = test::Room::box_with_pillars();
  for (const MapPoint& point : rig.odometry.map()) {
    const Eigen::Vector3d at = point.position_W_m.cast<double>();
    const double off_m = (at.head<2>() - kVisitor.centre_m).norm() - kVisitor.radius_m;
    if (std::abs(off_m) < 0.1 && alone.distance(at) > 0.8) ++count;
  }
  return count;
}

TEST(FreeSpace, WhoWalkedAwayIsLeftOutOfTheMap) {
  RoomRig stays(true_params());
  stays.room.pillars.push_back(kVisitor);
  RoomRig leaves = stays;
  stays.run(0, kEnd);
  leaves.run(0, kLeaves);
  const std::size_t seen = on_the_visitor(leaves);
  ASSERT_GT(seen, 50u);
  leaves.room.pillars.pop_back();
  leaves.run(kLeaves, kEnd);
  EXPECT_EQ(leaves.report.verdict, SweepVerdict::registered);
  // points that the sensor passes too closely, or that few rings see, remain
  EXPECT_LT(on_the_visitor(leaves), seen / 5);
  EXPECT_GE(on_the_visitor(stays), seen);
}

TEST(FreeSpace, LeavesARoomAloneInWhichNobodyMoves) {
  RoomRig rig(true_params());
  std::size_t drawn = 0;
  for (int k = 0; k < kEnd; ++k) {
    rig.run(k, k + 1);
    drawn += rig.report.map_points_added;
  }
  ASSERT_GT(drawn, 1000u);
  EXPECT_GE(rig.odometry.map().size(), drawn - drawn / 1000);
}

}  // namespace
}  // namespace tumble
