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

std::vector<MapPoint> read_map(const std::filesystem::path& path);

inline constexpr const char* kPriorMapName = "map.tumblemap";

void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points);

/// Reads a map for localisation. If the file has no columns for normals (nx ny nz or normal_x normal_y normal_z), the
/// normals are fitted to the points. The column `sigma` contains the standard deviation of each point [m].
std::vector<MapPoint> read_prior_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
