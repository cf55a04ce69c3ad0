// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// All fields are converted to double, so a time stamp in nanoseconds since 1970 is accurate to 256 ns.
struct Cloud {
  std::vector<std::string> names;            ///< without CloudCompare's prefix "scalar_"
  std::vector<std::vector<double>> columns;  ///< parallel to `names`, one number per point
  std::size_t points = 0;
  std::string viewpoint;  ///< VIEWPOINT of a PCD file; not applied

  const std::vector<double>* find(const std::string& name) const;
};

inline constexpr std::uint64_t kCloudPointsMax = std::uint64_t{1} << 26;

/// Reads PLY and PCD files of any encoding (by PCL), legacy VTK text (vtk_file.hpp), and .bin files without header. The
/// header is compared with the file size before memory is allocated.
///
/// @param bin_columns Columns of a .bin file in order, "x,y,z,intensity,ring". Each column is float32, or has a NumPy
/// type after a colon ("x:f8"); columns with the name "_" are skipped. If `bin_columns` is empty, the columns are x y z
/// intensity (KITTI), unless the content contradicts this layout (bin_layout.hpp).
///
/// Throws BadInput with file and location if the file is missing or damaged, or has another format, impossible columns,
/// or more than 2^26 points.
Cloud read_cloud(const std::filesystem::path& path, const std::string& bin_columns = "");

struct CloudHeader {
  std::uint64_t points = 0;
  std::uint64_t point_bytes = 0;  ///< bytes per point; 0 for text
  std::uint64_t header_bytes = 0;
  std::size_t fields = 0;
  std::uint64_t numbers = 0;  ///< numbers per point, over all fields
  bool ascii = false;
  std::string viewpoint;  ///< VIEWPOINT: x y z qw qx qy qz
};

CloudHeader read_ply_header(const std::filesystem::path& path);
CloudHeader read_pcd_header(const std::filesystem::path& path);

}  // namespace tumble::scenarios
