// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/sweep_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/export_names.hpp"

namespace tumble::scenarios {

namespace {

std::vector<std::size_t> order_of(const sim::LidarRecord& lidar, std::size_t sweep, bool in_time_order) {
  std::vector<std::size_t> points(lidar.sweep_first[sweep + 1] - lidar.sweep_first[sweep]);
  std::iota(points.begin(), points.end(), lidar.sweep_first[sweep]);
  if (in_time_order) {
    const auto earlier = [&](std::size_t a, std::size_t b) { return lidar.offset_ns[a] < lidar.offset_ns[b]; };
    std::stable_sort(points.begin(), points.end(), earlier);
  }
  return points;
}

template <class Number>
Number as(double value) {
  if constexpr (std::is_integral_v<Number>) {
    constexpr double kMost = std::numeric_limits<Number>::max();
    return static_cast<Number>(std::clamp(std::round(value), 0.0, kMost));
  } else {
    return static_cast<Number>(value);
  }
}

double value_of(const sim::LidarRecord& lidar, std::size_t point, const PointColumn& column, std::int64_t start_ns) {
  switch (column.quantity) {
    case PointQuantity::x_m:
      return lidar.position_L_m[point].x();
    case PointQuantity::y_m:
      return lidar.position_L_m[point].y();
    case PointQuantity::z_m:
      return lidar.position_L_m[point].z();
    case PointQuantity::intensity:
      return lidar.intensity[point] * column.scale;
    case PointQuantity::ring:
      return lidar.ring[point];
    case PointQuantity::time:
      return (static_cast<double>(column.absolute ? start_ns : 0) + lidar.offset_ns[point]) * column.scale;
  }
  return 0.0;
}

struct WrittenType {
  ros::PointField::Type type;
  std::uint32_t bytes;
};

WrittenType field_type(NumberType type) {
  switch (type) {
    case NumberType::uint8:
      return {ros::PointField::uint8, 1};
    case NumberType::uint16:
      return {ros::PointField::uint16, 2};
    case NumberType::uint32:
      return {ros::PointField::uint32, 4};
    case NumberType::float32:
      return {ros::PointField::float32, 4};
    case NumberType::float64:
      break;
  }
  return {ros::PointField::float64, 8};
}

template <class Put>
void with_number(NumberType type, Put&& put) {
  switch (type) {
    case NumberType::uint8:
      return put(std::uint8_t{});
    case NumberType::uint16:
      return put(std::uint16_t{});
    case NumberType::uint32:
      return put(std::uint32_t{});
    case NumberType::float32:
      return put(float{});
    case NumberType::float64:
      return put(double{});
  }
}

ros::PointCloud2 cloud_of(const sim::LidarRecord& lidar, const std::vector<std::size_t>& points,
                          const std::vector<PointColumn>& columns, std::int64_t start_ns, const ros::Header& header) {
  ros::PointCloud2 out;
  out.header = header;
  std::vector<PointColumn> written;
  for (const PointColumn& column : columns) {
    if (column.quantity == PointQuantity::time && !has_timed_points(lidar)) continue;
    const WrittenType field = field_type(column.type);
    out.fields.push_back({column.name, out.point_step, field.type, 1});
    out.point_step += field.bytes;
    written.push_back(column);
  }
  out.width = static_cast<std::uint32_t>(points.size());
  out.row_step = out.width * out.point_step;
  out.data.resize(out.row_step);
  for (std::size_t c = 0; c < written.size(); ++c) {
    with_number(written[c].type, [&](auto number) {
      std::uint8_t* at = out.data.data() + out.fields[c].offset;
      for (const std::size_t point : points) {
        number = as<decltype(number)>(value_of(lidar, point, written[c], start_ns));
        std::memcpy(at, &number, sizeof(number));
        at += out.point_step;
      }
    });
  }
  return out;
}

ros::LivoxCustomMsg livox_of(const sim::LidarRecord& lidar, const std::vector<std::size_t>& points,
                             std::int64_t start_ns, const ros::Header& header) {
  constexpr double kFull = 255.0;
  if (!has_timed_points(lidar)) {
    throw BadInput(
        fmt::format("the points of lidar '{}' have no time stamps, but a Livox CustomMsg needs measured time stamps; "
                    "choose another format",
                    lidar.name));
  }
  ros::LivoxCustomMsg out;
  out.header = header;
  out.timebase = static_cast<std::uint64_t>(start_ns);
  out.point_num = static_cast<std::uint32_t>(points.size());
  out.points.reserve(points.size());
  for (const std::size_t k : points) {
    if (lidar.ring[k] > std::numeric_limits<std::uint8_t>::max()) {
      throw BadInput(fmt::format("a point of lidar '{}' has ring {}; a Livox CustomMsg can only store rings 0 to 255",
                                 lidar.name, lidar.ring[k]));
    }
    const Eigen::Vector3f& p = lidar.position_L_m[k];
    if (!p.allFinite() || !std::isfinite(lidar.intensity[k])) {
      throw BadInput(fmt::format(
          "point {} of lidar '{}' is not finite; a Livox CustomMsg cannot store a missing return", k, lidar.name));
    }
    // The tag 0 of a Livox point means a single return with full confidence.
    out.points.push_back({lidar.offset_ns[k], p.x(), p.y(), p.z(), as<std::uint8_t>(lidar.intensity[k] * kFull), 0,
                          static_cast<std::uint8_t>(lidar.ring[k])});
  }
  return out;
}

}  // namespace

SweepLayout own_sweep_layout() {
  using enum PointQuantity;
  using enum NumberType;
  return {{{"x", x_m, float32},
           {"y", y_m, float32},
           {"z", z_m, float32},
           {"intensity", intensity, float32},
           {"ring", ring, uint16},
           {"time", time, float32, 1e-9},
           {"offset_ns", time, uint32}}};
}

SweepLayout livox_sweep_layout() {
  return {{}, true, true};
}

ros::Message sweep_message(const sim::LidarRecord& lidar, std::size_t sweep, const SweepLayout& layout,
                           std::int64_t start_ns, const ros::Header& header) {
  const std::vector<std::size_t> points = order_of(lidar, sweep, layout.in_time_order);
  if (layout.livox) return livox_of(lidar, points, start_ns, header);
  return cloud_of(lidar, points, layout.columns, start_ns, header);
}

}  // namespace tumble::scenarios
