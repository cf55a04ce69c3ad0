// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Points as a file or a message holds them: named columns of numbers, none of them interpreted. A 64 bit integer keeps
/// the 53 leading bits: stamps since the epoch in nanoseconds come to within 256 ns.
struct Cloud {
  std::vector<std::string> names;            ///< as written, but for a prefix "scalar_", which CloudCompare adds
  std::vector<std::vector<double>> columns;  ///< parallel to `names`, one number per point
  std::size_t points = 0;
  std::string viewpoint;  ///< of a PCD that states another pose than the sensor's own, as written: not applied

  /// The column of that name; null when there is none.
  const std::vector<double>* find(const std::string& name) const;
};

inline constexpr std::uint64_t kCloudPointsMax = std::uint64_t{1} << 26;

/// Reads the points of a PLY or PCD file of any encoding (by PCL), of a legacy VTK file written as text (vtk_file.hpp),
/// or of a .bin file, which has no header; the file's ending tells which. A file without points is a cloud without
/// points. What the header promises is held against the file's size before anything is allocated.
///
/// @param bin_columns  Columns of a .bin file in order, "x,y,z,intensity,ring". Each is float32, or has a type of NumPy
///                     behind a colon ("x:f8"); bytes without meaning are called "_". "": KITTI's x y z intensity; the
///                     content must not contradict (bin_layout.hpp).
/// Throws BadInput with file and place: absent, another format, a damaged header, truncated, more than 2^26 points,
/// columns that cannot be, content that contradicts KITTI's columns.
Cloud read_cloud(const std::filesystem::path& path, const std::string& bin_columns = "");

/// What the header of a PLY or PCD file promises.
struct CloudHeader {
  std::uint64_t points = 0;
  std::uint64_t point_bytes = 0;  ///< 0 when written as text
  std::uint64_t header_bytes = 0;
  std::size_t fields = 0;
  std::uint64_t numbers = 0;  ///< per point, of all fields
  bool ascii = false;
  std::string viewpoint;  ///< of a PCD: x y z qw qx qy qz, as written; "" for the sensor's own
};

/// Reads and checks a header alone; the same errors.
CloudHeader read_ply_header(const std::filesystem::path& path);
CloudHeader read_pcd_header(const std::filesystem::path& path);

}  // namespace tumble::scenarios
