// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

inline constexpr const char* kPriorMapName = "map.tumblemap";

void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points);

/// If the file has no columns nx ny nz or normal_x normal_y normal_z, the normals are fitted to the points. The column
/// `sigma` contains the standard deviation of each point [m].
std::vector<MapPoint> read_prior_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
