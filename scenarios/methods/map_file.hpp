// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tumble/mapping/lidar.hpp"

namespace tumble::scenarios {

/// Writes a map as binary little-endian PLY: x y z nx ny nz sigma, float32 each. Throws BadInput when it cannot.
void write_map(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Reads such a file. Throws BadInput with path and reason: absent, another layout, truncated.
std::vector<MapPoint> read_map(const std::filesystem::path& path);

/// The same as PCD, binary, by PCL: x y z, normal_x normal_y normal_z, and sigma in the field `intensity`, which PCL's
/// viewers colour by. Bit for bit what was given. Throws BadInput when it cannot, and for a map without a point.
void write_pcd_map(const std::filesystem::path& path, std::span<const MapPoint> map);

/// Reads a PCD file of any encoding that has these fields. Throws BadInput: absent, damaged, truncated, a field
/// missing.
std::vector<MapPoint> read_pcd_map(const std::filesystem::path& path);

}  // namespace tumble::scenarios
