// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Cloud contains the points of a file or message as uninterpreted named columns. A 64-bit integer keeps its 53 leading
/// bits, so stamps since 1970 in nanoseconds are accurate to 256 ns.
struct Cloud {
  std::vector<std::string> names;            ///< as written, without CloudCompare's prefix "scalar_"
  std::vector<std::vector<double>> columns;  ///< parallel to `names`, one number per point
  std::size_t points = 0;
  std::string viewpoint;  ///< VIEWPOINT of a PCD if it is not the identity, as written; not applied

  /// Returns the column called `name`, or null.
  const std::vector<double>* find(const std::string& name) const;
};

inline constexpr std::uint64_t kCloudPointsMax = std::uint64_t{1} << 26;

/// Reads the points of a file; the extension selects the format. The formats are PLY and PCD of any encoding (by PCL),
/// legacy VTK text (vtk_file.hpp), and .bin, which has no header. A file without points gives an empty cloud. The
/// reader checks the header against the file size before any allocation.
///
/// @param bin_columns  Columns of a .bin file in order, "x,y,z,intensity,ring". Each column is float32, or has a
///                     NumPy type after a colon ("x:f8"); the name "_" skips bytes. An empty text means KITTI's
///                     x y z intensity; the content must not contradict KITTI's layout (bin_layout.hpp).
/// Throws BadInput with file and location if the file is missing or truncated, has another format, a damaged header,
/// more than 2^26 points or impossible columns, or if its content contradicts KITTI's columns.
Cloud read_cloud(const std::filesystem::path& path, const std::string& bin_columns = "");

/// CloudHeader is the content of a PLY or PCD header.
struct CloudHeader {
  std::uint64_t points = 0;
  std::uint64_t point_bytes = 0;  ///< 0 for text
  std::uint64_t header_bytes = 0;
  std::size_t fields = 0;
  std::uint64_t numbers = 0;  ///< numbers per point, over all fields
  bool ascii = false;
  std::string viewpoint;  ///< of a PCD: x y z qw qx qy qz, as written; "" for the identity
};

/// These functions read and check only the header of a point file. The header readers throw BadInput like read_cloud.
CloudHeader read_ply_header(const std::filesystem::path& path);
CloudHeader read_pcd_header(const std::filesystem::path& path);

}  // namespace tumble::scenarios
