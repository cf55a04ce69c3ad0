// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

/// Assigns numbers to the scan lines of the lidar. Sweeps with equal attitude of the lidar have equal numbers, because
/// their rings coincide.
class ScanLines {
 public:
  /// Returns the number of ring 0 for a sweep with the given spin axis of the lidar, or VoxelMap::kUnknownScanLine if
  /// the lidar does not report rings.
  std::uint32_t line_number_offset(const Eigen::Vector3d& spin_axis_W, bool has_ring_numbers);
  static std::uint32_t line(std::uint32_t base, std::uint16_t ring) {
    return base == VoxelMap::kUnknownScanLine ? base : base | ring;
  }

 private:
  Eigen::Vector3d axis_W_ = Eigen::Vector3d::Zero();  // spin axis of the sweeps with equal numbers
  std::uint32_t attitude_ = 0;
};

/// Returns the points of a map. Normals are fitted to nearest neighbours, and point to the sensor that observed the
/// point. Cost: O(n).
std::vector<MapPoint> to_map_points(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                    double match_distance_m);

}  // namespace tumble::mapping
