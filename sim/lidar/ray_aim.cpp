// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/ray_aim.hpp"

#include <algorithm>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

struct Shares {
  alignas(64) double share[kLanes], first[kLanes], second[kLanes];
  alignas(64) double within[kLanes];  ///< 1 from the interval's first lane
};

[[gnu::target("avx2")]] void weigh(const TrackCursor::Interval& now, Shares& shares) {
  alignas(64) double angle2[kLanes], sinc[kLanes], cosc[kLanes];
  double largest2 = 0.0;
  for (int s = 0; s < kLanes; ++s) {
    angle2[s] = shares.share[s] * shares.share[s] * now.angle2;
    sinc[s] = TrackCursor::sinc_of_small(angle2[s]);
    cosc[s] = TrackCursor::cosc_of_small(angle2[s]);
  }
  for (int s = 0; s < kLanes; ++s) largest2 = std::max(largest2, angle2[s]);
  for (int s = largest2 < TrackCursor::kSmall2 ? kLanes : 0; s < kLanes; ++s) {
    if (angle2[s] < TrackCursor::kSmall2) continue;
    sinc[s] = TrackCursor::sinc_of(angle2[s]);
    cosc[s] = TrackCursor::cosc_of(angle2[s]);
  }
  for (int s = 0; s < kLanes; ++s) {
    shares.first[s] = shares.share[s] * sinc[s];
    shares.second[s] = shares.share[s] * shares.share[s] * cosc[s];
  }
}

[[gnu::target("avx2")]] void follow_number(const TrackCursor::Interval& now, const Shares& shares, int row, int column,
                                           double (&pose)[kLanes], double (&rate)[kLanes]) {
  const double start = now.start(row, column), turned = now.turned(row, column), twice = now.rotated_twice(row, column);
  const double per_s = now.per_s, angle2 = now.angle2;
  alignas(64) double to[kLanes], to_rate[kLanes];
  for (int s = 0; s < kLanes; ++s) {
    to[s] = start + shares.first[s] * turned + shares.second[s] * twice;
    to_rate[s] = per_s * ((1.0 - shares.second[s] * angle2) * turned + shares.first[s] * twice);
  }
  if (column == 3) {
    const double step_m = now.step_m[row];
    for (int s = 0; s < kLanes; ++s) {
      to[s] += shares.share[s] * step_m;
      to_rate[s] += per_s * step_m;
    }
  }
  for (int s = 0; s < kLanes; ++s) {
    pose[s] = shares.within[s] != 0.0 ? to[s] : pose[s];
    rate[s] = shares.within[s] != 0.0 ? to_rate[s] : rate[s];
  }
}

[[gnu::target("avx2")]] void aim_coordinate(const double (*pose)[kLanes], const double (*rate)[kLanes], int row,
                                            double after_s, const ChannelFirings& firings, float* origin,
                                            float* direction) {
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
  const auto start_ns = [&](int lane) { return block.start_ns[std::min(lane, block.slots - 1)]; };
  const auto middle_ns = [&](int lane) { return start_ns(lane) + length_ns / 2; };
  broken_count_ = 0;
  for (int from = 0; from < kLanes;) {
    const TrackCursor::Interval& now = track.interval(middle_ns(from));
    Shares shares;
    for (int s = 0; s < kLanes; ++s) {
      shares.within[s] = s >= from ? 1.0 : 0.0;
      shares.share[s] = now.share(middle_ns(std::max(s, from)));
    }
    weigh(now, shares);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        follow_number(now, shares, row, column, pose_[3 * row + column], rate_[3 * row + column]);
      follow_number(now, shares, row, 3, pose_[9 + row], rate_[9 + row]);
    }
    int end = from;
    for (; end < kLanes && now.holds(middle_ns(end)); ++end) {
      const bool smooth = start_ns(end) >= now.start_ns && start_ns(end) + length_ns < now.end_ns;
      if (!smooth && end < block.slots) broken_lane_[broken_count_++] = end;
    }
    from = end;
  }
  for (int i = 0; i < broken_count_; ++i) {
    for (int c = 0; c < pattern.channels(); ++c) {
      broken_pose_[i][c] = track.at(start_ns(broken_lane_[i]) + pattern.lag_ns(c));
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
