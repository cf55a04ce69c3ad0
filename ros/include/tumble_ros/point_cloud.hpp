// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble::ros {

/// PointField describes one field of a point, like sensor_msgs/PointField.
struct PointField {
  std::string name;
  std::uint32_t offset = 0;   ///< byte within the point
  std::uint8_t datatype = 0;  ///< number of sensor_msgs/PointField: 1 (int8) to 8 (float64)
  std::uint32_t count = 1;
};

/// PointCloudView refers to the contents of a sensor_msgs/PointCloud2.
struct PointCloudView {
  TimeNs stamp_ns = 0;
  std::uint32_t height = 0, width = 0;
  std::span<const PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::span<const std::uint8_t> data;
};

/// TimedSweep contains the arguments of TumblingOdometry::add_sweep().
struct TimedSweep {
  TimeNs start_ns = 0, end_ns = 0;
  std::vector<LidarPoint> points;
};

/// PointCloudReader converts the points of lidar drivers to the library's points, sweep by sweep. PointCloudReader
/// needs only the current and earlier sweeps.
///
/// The fields x, y, z and a time are required. Intensity ("intensity", "reflectivity") and ring ("ring", "line",
/// "channel") are optional. A time field is called "t", "time", "timestamp", "timestamps", "time_stamp", "offset_time",
/// "time_offset" or "offset", in any case, with or without the suffix _s, _ms, _us or _ns. If several fields have such
/// a name, the field whose suffix states the unit is used.
///
/// The suffix of a time field states the unit. Without a suffix, the first sweep of at least 100 points determines the
/// time unit. The times of a sweep span 1 ms to 1 s, and units differ by factors of 1000, so only one unit fits. Times
/// are relative to the header's stamp or absolute, whichever puts the first point closer to the stamp. If neither is
/// within a second of the stamp, the times belong to another clock, and the first point is assumed to be measured at
/// the stamp.
///
/// | driver | field | type | times |
/// | --- | --- | --- | --- |
/// | Velodyne | time | float32 | s after the stamp, or before the stamp if negative |
/// | Ouster | t | uint32 | ns after the stamp |
/// | Hesai, RoboSense | timestamp | float64 | s since 1970 |
/// | Livox | timestamp, offset_time | float64, uint32 | ns since 1970, ns after the stamp |
class PointCloudReader {
 public:
  /// @param time_field  name of the time field; empty: by the names above
  explicit PointCloudReader(std::string time_field = {}) : time_field_(std::move(time_field)) {}

  /// Converts a point cloud to a sweep. Points that are not finite or at the origin are misses and are dropped.
  /// Intensities above 1 are divided by 255, or by the largest intensity of the sweep if that is more. Returns an error
  /// and leaves `sweep` unspecified: `empty` (a field is missing, or no point), `too_few` (the unit is unknown, and
  /// there are fewer than 100 points), `degenerate` (all times are equal: deskewing is impossible), `out_of_range`
  /// (big-endian, a layout that does not fit the data, two possible time fields, or a time span above 1 s). Cost:
  /// O(points). The function reuses the memory of `sweep`.
  Status read(const PointCloudView& cloud, TimedSweep& sweep);

 private:
  struct Layout;
  Status find_fields(const PointCloudView& cloud, Layout& layout) const;
  Status find_unit(double span, std::size_t points);
  void set_times(TimeNs stamp_ns, double first, double last, TimedSweep& sweep) const;

  std::string time_field_;
  double unit_ns_ = 0.0;  ///< nanoseconds per unit of the time field; 0: not known yet
  std::vector<double> times_;
};

}  // namespace tumble::ros
