// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/lidar/beam_pattern.hpp"
#include "sim/lidar/track_cursor.hpp"

namespace tumble::sim {

/// Poses of the lidar over a block of firings, and rays in world axes from them, each at its own firing's time.
/// Within a slot (50 us) the pose goes on at the rate of the slot's middle: at 20 rad/s that leaves (rate dt)^2 / 2 =
/// 1e-7 rad. A slot in which the motion changes its rate (a sample of the track lies inside) gets a pose per firing.
class BlockPoses {
 public:
  void follow(const BeamPattern& pattern, const FiringBlock& block, TrackCursor& track);

  /// Origins and directions of `rays` from those of a channel; everything else is left alone.
  void aim(const BeamPattern& pattern, const FiringBlock& block, const ChannelFirings& firings, int channel,
           RayPacket& rays) const;

 private:
  static constexpr int kPose = 12;  ///< rotation row by row, then position

  void aim_slowly(const ChannelFirings& firings, int broken, int channel, RayPacket& rays) const;

  alignas(64) double pose_[kPose][kLanes], rate_[kPose][kLanes];
  int broken_count_ = 0;
  int broken_lane_[kLanes];  ///< slots with a change of rate inside
  Pose34 broken_pose_[kLanes][kMaxChannels];
};

/// Rays in the axes of L.
void aim_in_lidar_axes(const ChannelFirings& firings, RayPacket& rays);

}  // namespace tumble::sim
