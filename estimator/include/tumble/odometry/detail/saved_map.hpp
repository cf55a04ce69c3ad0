// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// Saves a map: position, normal and standard deviation of each point, in the order of `points`. The saved bytes are
/// equal on every machine. The bytes contain the version of the format, the number of points and a checksum. A point
/// needs 28 bytes. Cost: O(points).
std::vector<std::byte> save_map(std::span<const MapPoint> points);

/// Loads a map of save_map(), for LidarInertialOdometry::use_map(). On error, `points` is unchanged, and the returned
/// status names the field, the value and the bound. `too_few` means truncated bytes. `non_finite` and `out_of_range`
/// mean other data, another version, damaged bytes, or points that check_prior_map() rejects.
Status load_map(std::span<const std::byte> bytes, std::vector<MapPoint>& points);

}  // namespace tumble
