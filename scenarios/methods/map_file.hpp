// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// Writes a map as binary little-endian PLY: x y z nx ny nz sigma, float32 each. Throws BadInput if writing fails.
void write_map(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Writes a map as binary PCD 0.7: x y z normal_x normal_y normal_z sigma, float32 each. Throws BadInput if writing
/// fails.
void write_map_pcd(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Reads a map from a PLY file that write_map wrote. Throws BadInput with path and reason if the file is missing or
/// truncated, or has another layout.
std::vector<MapPoint> read_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
