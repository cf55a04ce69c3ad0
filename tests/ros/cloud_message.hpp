// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "tumble_ros/point_cloud.hpp"

namespace tumble::test {

/// CloudMessage is a PointCloud2 message in memory, with fields as a driver writes them.
struct CloudMessage {
  std::vector<ros::PointField> fields;
  std::vector<std::uint8_t> data;
  std::uint32_t width = 0, point_step = 0;

  ros::PointCloudView view(TimeNs stamp_ns) const {
    return {stamp_ns, 1, width, fields, false, point_step, width * point_step, data};
  }
};

/// A Column contains a field's name, its datatype, and the function that gives its number for a point.
struct Column {
  std::string name;
  std::uint8_t datatype;
  std::function<double(const LidarPoint&)> number;
};

template <class Number>
void put(std::vector<std::uint8_t>& out, double value) {
  const Number number = static_cast<Number>(value);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&number);
  out.insert(out.end(), bytes, bytes + sizeof(number));
}

inline void put(std::vector<std::uint8_t>& out, std::uint8_t datatype, double value) {
  switch (datatype) {
    case 2:
      return put<std::uint8_t>(out, value);
    case 4:
      return put<std::uint16_t>(out, value);
    case 6:
      return put<std::uint32_t>(out, value);
    case 7:
      return put<float>(out, value);
    default:
      return put<double>(out, value);
  }
}

/// Returns the columns x, y and z, which every driver writes.
inline std::vector<Column> xyz() {
  std::vector<Column> out;
  for (int axis = 0; axis < 3; ++axis)
    out.push_back({std::string(1, char('x' + axis)), 7, [axis](const LidarPoint& p) { return p.position_L_m[axis]; }});
  return out;
}

inline CloudMessage cloud_message(const std::vector<LidarPoint>& points, std::vector<Column> columns) {
  CloudMessage out;
  for (const Column& column : columns) {
    constexpr std::uint32_t kBytes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    out.fields.push_back({column.name, out.point_step, column.datatype, 1});
    out.point_step += kBytes[column.datatype];
  }
  out.width = static_cast<std::uint32_t>(points.size());
  for (const LidarPoint& point : points)
    for (const Column& column : columns) put(out.data, column.datatype, column.number(point));
  return out;
}

/// Returns a cloud in the format of Ouster's driver, whose point times are exact.
inline CloudMessage ouster_cloud(const std::vector<LidarPoint>& points) {
  std::vector<Column> columns = xyz();
  columns.push_back({"t", 6, [](const LidarPoint& p) { return double(p.offset_ns); }});
  columns.push_back({"ring", 4, [](const LidarPoint& p) { return double(p.ring); }});
  return cloud_message(points, columns);
}

/// Returns a livox_ros_driver2/CustomMsg in little-endian CDR, as ROS 2 serializes the message. The last point has no
/// padding.
inline std::vector<std::uint8_t> livox_cdr(TimeNs stamp_ns, const std::string& frame,
                                           const std::vector<LidarPoint>& points) {
  std::vector<std::uint8_t> out = {0, 1, 0, 0};
  const auto align = [&](std::size_t to) { out.resize(4 + (out.size() - 4 + to - 1) / to * to); };
  const TimeNs whole_s = stamp_ns / 1'000'000'000;
  put<std::int32_t>(out, double(whole_s));
  put<std::uint32_t>(out, double(stamp_ns % 1'000'000'000));
  put<std::uint32_t>(out, double(frame.size() + 1));
  out.insert(out.end(), frame.begin(), frame.end());
  out.push_back(0);
  align(8);
  out.insert(out.end(), 8, std::uint8_t{7});  // timebase, in another clock
  put<std::uint32_t>(out, double(points.size()));
  out.insert(out.end(), {3, 0, 0, 0});  // lidar_id, rsvd
  put<std::uint32_t>(out, double(points.size()));
  for (const LidarPoint& point : points) {
    align(4);
    put<std::uint32_t>(out, double(point.offset_ns));
    for (const float axis : point.position_L_m) put<float>(out, axis);
    put<std::uint8_t>(out, 255.0 * point.intensity + 0.5);
    put<std::uint8_t>(out, 16.0);  // tag
    put<std::uint8_t>(out, double(point.ring));
  }
  return out;
}

}  // namespace tumble::test
