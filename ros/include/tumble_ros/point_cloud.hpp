// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble_ros/point_fields.hpp"

namespace tumble::ros {

/// TimedSweep contains the arguments of TumblingOdometry::add_sweep().
struct TimedSweep {
  TimeNs start_ns = 0, end_ns = 0;
  std::vector<LidarPoint> points;
};

/// PointCloudReader converts the points of lidar drivers to the library's points, sweep by sweep. PointCloudReader
/// needs only the current and earlier sweeps.
///
/// The fields x, y, z and a time (TimeFieldChoice) are required. The fields for intensity and ring (kIntensityNames,
/// kRingNames) are optional. LivoxCloud converts the message CustomMsg of Livox to a cloud with these fields.
///
/// The suffix _s, _ms, _us or _ns of the time field states the unit. Without a suffix, the first sweep of at least 100
/// points determines the time unit. The times of a sweep span 1 ms to 1 s, and units differ by factors of 1000, so only
/// one unit fits. Times are relative to the header's stamp or absolute. PointCloudReader selects the interpretation
/// that puts the first point closer to the stamp. If neither interpretation is within a second of the stamp, the times
/// belong to another clock. PointCloudReader then assumes that the first point was measured at the stamp.
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

  /// Converts a point cloud to a sweep. The function drops points that are not finite or at the origin, because these
  /// points stand for laser pulses without a return. If intensities exceed 1, the function divides all intensities of
  /// the sweep by the larger of 255 and the largest intensity. On error, `sweep` is unspecified. The errors are `empty`
  /// (a field is missing, or no point), `insufficient_data` (the unit is unknown, and there are fewer than 100 points),
  /// `degenerate` (all times are equal, so deskewing is impossible), and `out_of_range` (big-endian, a layout that does
  /// not fit the data, two possible time fields, or a time span above 1 s). Cost: O(points). The function reuses the
  /// memory of `sweep`.
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
