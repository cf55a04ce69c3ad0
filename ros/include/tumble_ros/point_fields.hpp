// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

/// point_fields.hpp reads the bytes and field names of point clouds from lidar drivers. The nodes and the import of
/// bags use these functions, so nodes and import accept the same formats.
namespace tumble::ros {

/// Size of a number of each datatype of PointField [bytes].
inline constexpr std::array<std::uint8_t, 9> kDatatypeBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};

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

  /// Returns the distance between the starts of two rows [bytes]. Some drivers write a row_step that is too small.
  std::size_t row_bytes() const;
};

/// Returns `out_of_range` for big-endian numbers, or for a layout or field that does not fit the data. Returns `empty`
/// for a cloud without points.
Status check_layout(const PointCloudView& cloud);
/// Returns true if a field contains one number of a known type.
bool is_number(const PointField& field);
/// Returns the number of a field. `point` is the first byte of the point.
double number_at(const std::uint8_t* point, const PointField& field);

/// TimeUnit is a unit of time. The name of a field with this unit ends in `suffix`.
struct TimeUnit {
  std::string_view suffix;
  double ns;
};
inline constexpr std::array<TimeUnit, 4> kTimeUnits = {{{"_s", 1e9}, {"_ms", 1e6}, {"_us", 1e3}, {"_ns", 1.0}}};
/// Accepted names of fields, in lower case.
inline constexpr std::array<std::string_view, 2> kIntensityNames = {"intensity", "reflectivity"};
inline constexpr std::array<std::string_view, 3> kRingNames = {"ring", "line", "channel"};

std::string lower_case(std::string_view text);
/// Returns the unit that the suffix of a field's name states, or null.
const TimeUnit* stated_unit(std::string_view name);

/// TimeFieldChoice selects the field with the times of the points. The names are "t", "time", "timestamp",
/// "timestamps", "time_stamp", "offset_time", "time_offset" and "offset", in upper or lower case, with or without the
/// suffix of a unit. A field that states its unit has priority.
struct TimeFieldChoice {
  std::string field, rival;  ///< name of the selected field, and of a second field with equal priority; empty: none

  void offer(const std::string& name);
};

/// LivoxCloud converts a livox_ros_driver2/CustomMsg to a cloud with the fields x, y, z, reflectivity, tag, line and
/// offset_time_ns. The message must be in CDR, the serialization of ROS 2. The message types of livox_ros_driver and
/// livox_interfaces have the same fields.
struct LivoxCloud {
  static bool is_type(std::string_view type) { return type.ends_with("/CustomMsg"); }

  /// Parses a message. Returns `ok`, `insufficient_data` if the bytes end early, or an error of check_layout().
  Status parse(std::span<const std::uint8_t> cdr);
  PointCloudView view() const;

  TimeNs stamp_ns = 0;
  std::string frame_id;

 private:
  std::uint32_t points_ = 0;
  std::vector<std::uint8_t> data_;
};

}  // namespace tumble::ros
