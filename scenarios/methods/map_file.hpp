// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// Writes a map as binary little-endian PLY: x y z nx ny nz sigma, float32 each. Throws BadInput if writing fails.
void write_map(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Reads such a map. Throws BadInput with path and reason: missing, another layout, truncated.
std::vector<MapPoint> read_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
