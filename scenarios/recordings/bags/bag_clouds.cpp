// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_clouds.hpp"

#include <fmt/format.h>

#include <xxhash.h>

#include <array>

#include "scenarios/errors.hpp"
#include "tumble_ros/point_fields.hpp"

namespace tumble::scenarios {

bool is_livox_type(const std::string& type) {
  return type == ros::kLivoxRos1 || type == "livox_ros_driver2/CustomMsg" || type == "livox_interfaces/CustomMsg";
}

Cloud cloud_of(const ros::PointCloud2& message, const std::string& where) {
  std::vector<tumble::ros::PointField> fields;
  for (const ros::PointField& field : message.fields)
    fields.push_back({field.name, field.offset, field.datatype, field.count});
  const tumble::ros::PointCloudView view{0,
                                         message.height,
                                         message.width,
                                         fields,
                                         message.is_bigendian != 0,
                                         message.point_step,
                                         message.row_step,
                                         message.data};
  Cloud out;
  const Status status = check_layout(view);
  if (status.error_code == ErrorCode::empty) return out;
  if (!status.ok()) {
    throw BadInput(fmt::format(
        "{}: the cloud of {} x {} points with {} bytes each does not fit its data of {} bytes, or is not supported: {}",
        where, view.height, view.width, view.point_step, view.data.size(), status.message()));
  }
  out.points = std::size_t{view.width} * view.height;
  for (const tumble::ros::PointField& field : fields) {
    if (!is_number(field)) continue;
    out.names.push_back(field.name);
    std::vector<double>& column = out.columns.emplace_back();
    column.reserve(out.points);
    for (std::uint32_t row = 0; row < view.height; ++row) {
      const std::uint8_t* at = view.data.data() + row * view.row_bytes();
      for (std::uint32_t i = 0; i < view.width; ++i, at += view.point_step) column.push_back(number_at(at, field));
    }
  }
  return out;
}

Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where) {
  if (message.point_num != message.points.size()) {
    throw BadInput(fmt::format("{}: the header of the cloud states {} points, but the message contains {} points",
                               where, message.point_num, message.points.size()));
  }
  Cloud out;
  out.points = message.points.size();
  out.names = {"x", "y", "z", "reflectivity", "tag", "line", "offset_time_ns"};
  out.columns.assign(out.names.size(), std::vector<double>(out.points));
  for (std::size_t i = 0; i < out.points; ++i) {
    const ros::LivoxPoint& point = message.points[i];
    const double numbers[] = {point.x,
                              point.y,
                              point.z,
                              static_cast<double>(point.reflectivity),
                              static_cast<double>(point.tag),
                              static_cast<double>(point.line),
                              static_cast<double>(point.offset_time)};
    for (std::size_t c = 0; c < out.columns.size(); ++c) out.columns[c][i] = numbers[c];
  }
  return out;
}

std::uint64_t content_of(const ros::PointCloud2& message) {
  return XXH3_64bits(message.data.data(), message.data.size());
}

std::uint64_t content_of(const ros::LivoxCustomMsg& message) {
  std::uint64_t digest = message.timebase;
  for (const ros::LivoxPoint& point : message.points) {
    const std::array numbers = {point.x, point.y, point.z, static_cast<float>(point.reflectivity)};
    digest = XXH3_64bits_withSeed(numbers.data(), sizeof numbers, digest + point.offset_time);
  }
  return digest;
}

}  // namespace tumble::scenarios
