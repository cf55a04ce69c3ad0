// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// kPriorMapName is the file in the folder of an estimate with the map for later runs (save_map).
inline constexpr const char* kPriorMapName = "map.tumblemap";

/// Writes a map for later runs. Throws BadInput if writing fails.
void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points);

/// Reads a map: a file of write_prior_map, or the points of a PCD or PLY file. Normals are those of the file (columns
/// nx ny nz, or normal_x normal_y normal_z), or are fitted to the points. A column `sigma` is the standard deviation of
/// a point. Throws BadInput with path and reason.
std::vector<MapPoint> read_prior_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
