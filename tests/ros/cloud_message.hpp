// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "tumble_ros/point_cloud.hpp"

namespace tumble::test {

/// A PointCloud2 in memory, with fields as a driver writes them.
struct CloudMessage {
  std::vector<ros::PointField> fields;
  std::vector<std::uint8_t> data;
  std::uint32_t width = 0, point_step = 0;

  ros::PointCloudView view(TimeNs stamp_ns) const {
    return {stamp_ns, 1, width, fields, false, point_step, width * point_step, data};
  }
};

/// Name and data type of a field, and its value for a point.
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

/// Fields x, y and z, as in every driver.
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

/// Fields of Ouster's driver, with exact times.
inline CloudMessage ouster_cloud(const std::vector<LidarPoint>& points) {
  std::vector<Column> columns = xyz();
  columns.push_back({"t", 6, [](const LidarPoint& p) { return double(p.offset_ns); }});
  columns.push_back({"ring", 4, [](const LidarPoint& p) { return double(p.ring); }});
  return cloud_message(points, columns);
}

}  // namespace tumble::test
