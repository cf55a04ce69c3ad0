// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// kPriorMapName is the name of the map file for later runs in the folder of an estimate (save_map).
inline constexpr const char* kPriorMapName = "map.tumblemap";

/// Writes map points to a file that later runs can use as prior map. Throws BadInput if writing fails.
void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points);

/// Reads a map from a file of write_prior_map, or from the points of a PCD or PLY file. The normals are those of the
/// file (columns nx ny nz, or normal_x normal_y normal_z), or are fitted to the points. The column `sigma` of the file
/// is the standard deviation of a point. Throws BadInput with path and reason if reading fails.
std::vector<MapPoint> read_prior_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
