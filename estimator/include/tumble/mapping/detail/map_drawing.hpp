// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

/// Numbers the scan lines of sweeps: sweeps at a constant attitude share line numbers.
class ScanLines {
 public:
  /// Returns the line number of ring 0 of a sweep with the given spin axis, or VoxelMap::kUnknownScanLine if the device
  /// does not report rings.
  std::uint32_t line_number_offset(const Eigen::Vector3d& spin_axis_W, bool has_ring_numbers);
  static std::uint32_t line(std::uint32_t base, std::uint16_t ring) {
    return base == VoxelMap::kUnknownScanLine ? base : base | ring;
  }

 private:
  Eigen::Vector3d axis_W_ = Eigen::Vector3d::Zero();  // spin axis of the sweeps that share lines
  std::uint32_t attitude_ = 0;                        // number of attitude changes
};

/// Returns the points of a map, with normals fitted to nearest neighbours and pointing to the observing sensor. Cost:
/// O(n).
std::vector<MapPoint> to_map_points(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                    double match_distance_m);

}  // namespace tumble::mapping
