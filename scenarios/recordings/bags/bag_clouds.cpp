// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_clouds.hpp"

#include <fmt/format.h>

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

template <class Number>
void take_column(const ros::PointCloud2& cloud, std::size_t row_bytes, std::size_t offset, std::vector<double>& out) {
  std::size_t point = 0;
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    for (std::uint32_t i = 0; i < cloud.width; ++i) {
      Number value;
      std::memcpy(&value, cloud.data.data() + row * row_bytes + std::size_t{i} * cloud.point_step + offset,
                  sizeof(value));
      out[point++] = static_cast<double>(value);
    }
  }
}

struct ReadType {
  std::size_t bytes;
  void (*take)(const ros::PointCloud2&, std::size_t, std::size_t, std::vector<double>&);
};

/// Returns the type with this number, or null if the number is unknown.
const ReadType* type_of(std::uint8_t datatype) {
  static const ReadType known[] = {{1, take_column<std::int8_t>},  {1, take_column<std::uint8_t>},
                                   {2, take_column<std::int16_t>}, {2, take_column<std::uint16_t>},
                                   {4, take_column<std::int32_t>}, {4, take_column<std::uint32_t>},
                                   {4, take_column<float>},        {8, take_column<double>}};
  return datatype >= ros::PointField::int8 && datatype <= ros::PointField::float64 ? &known[datatype - 1] : nullptr;
}

}  // namespace

bool is_livox_type(const std::string& type) {
  return type == ros::kLivoxRos1 || type == "livox_ros_driver2/CustomMsg" || type == "livox_interfaces/CustomMsg";
}

// Checks the layout against the data before the conversion.
Cloud cloud_of(const ros::PointCloud2& message, const std::string& where) {
  if (message.is_bigendian != 0)
    throw BadInput(fmt::format("{}: points are big-endian; only little-endian points are supported", where));
  const std::uint64_t tight = std::uint64_t{message.width} * message.point_step;
  const std::uint64_t row_bytes = std::max<std::uint64_t>(message.row_step, tight);
  Cloud out;
  if (message.width == 0 || message.height == 0) return out;
  if (message.point_step == 0 || row_bytes > message.data.size() / message.height) {
    throw BadInput(fmt::format("{}: the cloud states {} x {} points of {} bytes, which do not fit its data of {} bytes",
                               where, message.height, message.width, message.point_step, message.data.size()));
  }
  out.points = std::size_t{message.width} * message.height;
  for (const ros::PointField& field : message.fields) {
    const ReadType* type = type_of(field.datatype);
    if (type == nullptr || field.count > 1) continue;  // count 0: some drivers mean one
    if (std::uint64_t{field.offset} + type->bytes > message.point_step) {
      throw BadInput(fmt::format("{}: field '{}' starts at byte {} and ends outside of a point, which has {} bytes",
                                 where, field.name, field.offset, message.point_step));
    }
    out.names.push_back(field.name);
    type->take(message, row_bytes, field.offset, out.columns.emplace_back(out.points));
  }
  return out;
}

Cloud cloud_of(const ros::LivoxCustomMsg& message, const std::string& where) {
  if (message.point_num != message.points.size()) {
    throw BadInput(
        fmt::format("{}: the cloud states {} points but contains {}", where, message.point_num, message.points.size()));
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
