// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// Name of the file in the folder of an estimate that contains the map for later runs (save_map).
inline constexpr const char* kPriorMapName = "map.tumblemap";

/// Writes map points to a file that later runs can use as prior map. Throws BadInput if writing fails.
void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points);

/// Reads a map from a file of write_prior_map, or from the points of a PCD or PLY file. The normals come from the
/// columns nx ny nz or normal_x normal_y normal_z; without these columns, they are fitted to the points. The column
/// `sigma` contains the standard deviation of each point. Throws BadInput with path and reason if reading fails.
std::vector<MapPoint> read_prior_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
