// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// The file is binary little-endian PLY: x y z nx ny nz sigma, float32 each.
void write_map(const std::filesystem::path& path, std::span<const MapPoint> map);

/// The file is binary PCD 0.7: x y z normal_x normal_y normal_z sigma, float32 each.
void write_map_pcd(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Throws BadInput with path and reason if the file is missing, truncated, or has another layout.
std::vector<MapPoint> read_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
