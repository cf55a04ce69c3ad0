// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble::mapping {

/// Numbers the scan lines of a map. Sweeps at a constant attitude scan the same lines of the world and share line
/// numbers. After a rotation the lines have new numbers.
class ScanLines {
 public:
  /// Returns the number of ring 0 of a sweep with this spin axis, or VoxelMap::kNoLine if rings are not distinguished.
  std::uint32_t base(const Eigen::Vector3d& spin_axis_W, bool rings_differ);
  static std::uint32_t line(std::uint32_t base, std::uint16_t ring) {
    return base == VoxelMap::kNoLine ? base : base | ring;
  }
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  Eigen::Vector3d axis_W_ = Eigen::Vector3d::Zero();  // spin axis of the sweeps that share lines
  std::uint32_t attitude_ = 0;                        // number of attitude changes
};

/// Returns the points of a map with normals fitted to nearest neighbours. Each normal points towards the sensor's
/// position at the time of observation. O(n).
std::vector<MapPoint> with_normals(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                   double match_distance_m);

}  // namespace tumble::mapping
