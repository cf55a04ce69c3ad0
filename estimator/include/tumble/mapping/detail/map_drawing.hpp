// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble::mapping {

/// Numbers the scan lines of a map: sweeps of a sensor that holds its attitude draw the same lines, one that turns
/// draws new ones.
class ScanLines {
 public:
  /// Number of ring 0 of a sweep whose spin axis stands so, or VoxelMap::kNoLine where rings are not told apart.
  std::uint32_t base(const Eigen::Vector3d& spin_axis_W, bool rings_differ);
  static std::uint32_t line(std::uint32_t base, std::uint16_t ring) {
    return base == VoxelMap::kNoLine ? base : base | ring;
  }
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  Eigen::Vector3d axis_W_ = Eigen::Vector3d::Zero();  // of the sweeps that share lines
  std::uint32_t attitude_ = 0;                        // counts changes of it
};

/// Points of a map with normals from the nearest neighbours that look towards where each was seen from. O(n).
std::vector<MapPoint> with_normals(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                   double match_distance_m);

}  // namespace tumble::mapping
