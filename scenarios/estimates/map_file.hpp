// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/types.hpp"

namespace tumble::scenarios {

/// Writes a binary little-endian PLY file with the float32 columns x, y, z, nx, ny, nz and sigma.
void write_map(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Writes a binary PCD 0.7 file with the float32 columns x, y, z, normal_x, normal_y, normal_z and sigma.
void write_map_pcd(const std::filesystem::path& path, std::span<const MapPoint> map);

inline constexpr const char* kPriorMapName = "map.tumblemap";

void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points);

/// Reads a .tumblemap, PLY or PCD file: tumble_ros/map_file.hpp. Throws BadInput if the file is missing or damaged, or
/// has another format.
std::vector<MapPoint> read_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
