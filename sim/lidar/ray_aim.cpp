// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/ray_aim.hpp"

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

/// Rotation row by row, then position.
void set_lane(const Pose34& pose, int lane, double (*to)[kLanes]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) to[3 * row + column][lane] = pose(row, column);
    to[9 + row][lane] = pose(row, 3);
  }
}

/// One world coordinate of all lanes: `row` of the rotation and the position's coordinate of that row.
[[gnu::target("avx2")]] void aim_coordinate(const double (*pose)[kLanes], const double (*rate)[kLanes], int row, double after_s,
                    const ChannelFirings& firings, float* origin, float* direction) {
  const double *ax = pose[3 * row], *ay = pose[3 * row + 1], *az = pose[3 * row + 2], *ap = pose[9 + row];
  const double *bx = rate[3 * row], *by = rate[3 * row + 1], *bz = rate[3 * row + 2], *bp = rate[9 + row];
  for (int s = 0; s < kLanes; ++s) {
    const double x = ax[s] + after_s * bx[s], y = ay[s] + after_s * by[s], z = az[s] + after_s * bz[s];
    origin[s] = static_cast<float>(ap[s] + after_s * bp[s] + x * firings.origin_x_m[s] + y * firings.origin_y_m[s] +
                                   z * firings.origin_z_m[s]);
    direction[s] =
        static_cast<float>(x * firings.direction_x[s] + y * firings.direction_y[s] + z * firings.direction_z[s]);
  }
}

}  // namespace

void BlockPoses::follow(const BeamPattern& pattern, const FiringBlock& block, TrackCursor& track) {
  const std::int64_t length_ns = pattern.slot_length_ns();
  broken_count_ = 0;
  Pose34 pose, rate_s;
  for (int s = 0; s < block.slots; ++s) {
    const std::int64_t start_ns = block.start_ns[s];
    track.at(start_ns + length_ns / 2, pose, rate_s);
    set_lane(pose, s, pose_);
    set_lane(rate_s, s, rate_);
    if (track.is_smooth(start_ns, start_ns + length_ns)) continue;
    for (int c = 0; c < pattern.channels(); ++c) {
      track.at(start_ns + pattern.lag_ns(c), broken_pose_[broken_count_][c], rate_s);
    }
    broken_lane_[broken_count_++] = s;
  }
  // lanes without a slot follow the last one, so that nothing is computed from numbers never set
  for (int i = 0; i < kPose; ++i) {
    for (int s = block.slots; s < kLanes; ++s) {
      pose_[i][s] = pose_[i][block.slots - 1];
      rate_[i][s] = rate_[i][block.slots - 1];
    }
  }
}

void BlockPoses::aim(const BeamPattern& pattern, const FiringBlock& block, const ChannelFirings& firings, int channel,
                     RayPacket& rays) const {
  const std::int64_t half_a_slot_ns = pattern.slot_length_ns() / 2;
  const double after_s = 1e-9 * static_cast<double>(pattern.lag_ns(channel) - half_a_slot_ns);
  aim_coordinate(pose_, rate_, 0, after_s, firings, rays.origin_x, rays.direction_x);
  aim_coordinate(pose_, rate_, 1, after_s, firings, rays.origin_y, rays.direction_y);
  aim_coordinate(pose_, rate_, 2, after_s, firings, rays.origin_z, rays.direction_z);
  rays.count = block.slots;
  for (int i = 0; i < broken_count_; ++i) aim_slowly(firings, i, channel, rays);
}

void BlockPoses::aim_slowly(const ChannelFirings& firings, int broken, int channel, RayPacket& rays) const {
  const int s = broken_lane_[broken];
  const Pose34& pose = broken_pose_[broken][channel];
  const Vector3d origin =
      pose.leftCols<3>() * Vector3d(firings.origin_x_m[s], firings.origin_y_m[s], firings.origin_z_m[s]) + pose.col(3);
  const Vector3d direction =
      pose.leftCols<3>() * Vector3d(firings.direction_x[s], firings.direction_y[s], firings.direction_z[s]);
  rays.origin_x[s] = static_cast<float>(origin.x());
  rays.origin_y[s] = static_cast<float>(origin.y());
  rays.origin_z[s] = static_cast<float>(origin.z());
  rays.direction_x[s] = static_cast<float>(direction.x());
  rays.direction_y[s] = static_cast<float>(direction.y());
  rays.direction_z[s] = static_cast<float>(direction.z());
}

[[gnu::target("avx2")]] void aim_in_lidar_axes(const ChannelFirings& firings, RayPacket& rays) {
  for (int s = 0; s < kLanes; ++s) {
    rays.origin_x[s] = static_cast<float>(firings.origin_x_m[s]);
    rays.origin_y[s] = static_cast<float>(firings.origin_y_m[s]);
    rays.origin_z[s] = static_cast<float>(firings.origin_z_m[s]);
    rays.direction_x[s] = static_cast<float>(firings.direction_x[s]);
    rays.direction_y[s] = static_cast<float>(firings.direction_y[s]);
    rays.direction_z[s] = static_cast<float>(firings.direction_z[s]);
  }
}

}  // namespace tumble::sim
