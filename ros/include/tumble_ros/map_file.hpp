// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::ros {

/// Reads the contents of a map file: a map saved by tumble::save_map(), or a point cloud in PLY or PCD format with the
/// fields x, y and z [m]. The encoding of a point cloud is ASCII, or binary with little-endian numbers and without
/// compression. Normals are read from the fields nx, ny and nz, or normal_x, normal_y and normal_z; without these
/// fields, read_map() fits normals to neighbouring points. The field sigma contains the standard deviation of a point's
/// position [m], which is 0.02 m without this field. Points that are not finite are left out. The viewpoint of a PCD
/// file is ignored.
///
/// Returns `ok`, an error of tumble::load_map(), or an error that names the wrong part of the header. Returns
/// `insufficient_data` if the file is truncated. On error, `points` is unchanged. Cost: O(n).
Status read_map(std::span<const std::byte> file, std::vector<MapPoint>& points);

/// Returns the contents of a binary PLY file with the float fields x, y, z, nx, ny, nz and sigma.
std::string ply_of(std::span<const MapPoint> map);

}  // namespace tumble::ros
