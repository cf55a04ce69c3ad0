// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/lidar/beam_pattern.hpp"
#include "sim/lidar/track_cursor.hpp"

namespace tumble::sim {

/// BlockPoses contains the lidar poses at the firing times of a block of slots (firing sequences). Within a slot (one
/// firing sequence, 50 us), the pose is extrapolated with the angular velocity at the middle of the slot. At 20 rad/s,
/// the extrapolation error is (rate dt)^2 / 2 = 1e-7 rad, for a time difference dt of half a slot.
class BlockPoses {
 public:
  void follow(const BeamPattern& pattern, const FiringBlock& block, TrackCursor& track);

  void aim(const BeamPattern& pattern, const FiringBlock& block, const ChannelFirings& firings, int channel,
           RayPacket& rays) const;

 private:
  static constexpr int kPose = 12;  ///< rotation by rows, then position

  void aim_slowly(const ChannelFirings& firings, int broken, int channel, RayPacket& rays) const;

  alignas(64) double pose_[kPose][kLanes], rate_[kPose][kLanes];
  int broken_count_ = 0;
  int broken_lane_[kLanes];  ///< lanes within which the angular velocity changes
  Pose34 broken_pose_[kLanes][kMaxChannels];
};

void aim_in_lidar_axes(const ChannelFirings& firings, RayPacket& rays);

}  // namespace tumble::sim
