// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_sweeps.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_imu.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "tumble_ros/point_fields.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kClocksApart_s = 1e-3;
/// Clocks of two computers may differ by up to 10 ms.
constexpr double kAhead_s = 0.01;

template <class Take>
void read_clouds(const OpenedBag& bag, const std::string& topic, LeftOut& left_out, Take&& take) {
  if (is_livox_type(bag.topic(topic).type)) return bag.read<ros::LivoxCustomMsg>(topic, take, &left_out);
  bag.read<ros::PointCloud2>(topic, take, &left_out);
}

/// Adds a note if a point time is later than the record stamp of its message, which is physically impossible.
void note_points_to_come(const std::string& topic, const BuiltSweeps& built, const std::vector<std::int64_t>& records,
                         std::vector<std::string>& notes) {
  std::vector<double> ahead_s;
  for (std::size_t k = 0; k < std::min(records.size(), built.last_point_ns.size()); ++k) {
    if (built.last_point_ns[k]) ahead_s.push_back(1e-9 * static_cast<double>(*built.last_point_ns[k] - records[k]));
  }
  if (ahead_s.empty()) return;
  const double middle_s = upper_median(std::move(ahead_s));
  if (middle_s < kAhead_s) return;
  notes.push_back(
      fmt::format("{}: caution: the last points of a sweep are {} s later than the record stamp, so the header stamp "
                  "may be the end of the sweep. The import assumes that the header stamp is the start (set '--stamps "
                  "record' to start each sweep one sweep period before its record stamp)",
                  topic, std::to_string(middle_s)));
}

void keep_in_order(const OpenedBag& bag, const std::string& topic, const BagStamps& stamps,
                   const std::vector<std::size_t>& numbers, CloudHeaders& out) {
  const std::vector<bool> in_order = stamps_in_order(stamps.times_ns());
  for (std::size_t k = 0; k < in_order.size(); ++k) {
    if (in_order[k]) {
      out.stamps.push_back(stamps.times_ns()[k]);
      out.starts[numbers[k]] = out.stamps.back();
    } else {
      out.left_out.add("a wrong time stamp", bag.place_of(topic, numbers[k]) + ": " + stamps.disorder(k));
    }
  }
  out.left_out.require_few(out.stamps.size());
}

}  // namespace

CloudHeaders read_headers(const OpenedBag& bag, const std::string& topic, const BagReading& reading) {
  CloudHeaders out;
  BagStamps stamps(reading.stamps);
  std::uint64_t before = 0;
  std::size_t repeated = 0;
  std::vector<std::size_t> numbers;
  read_clouds(bag, topic, out.left_out, [&](const auto& message, const MessageOrigin& origin) {
    out.frame = without_slash(message.header.frame_id);
    if (out.left_out_as_map(reading)) return;  // clouds of a map have equal stamps
    out.starts.resize(origin.number + 1);
    const std::int64_t header_ns = stamp_of(message.header);
    const std::uint64_t now = content_of(message);
    const bool repeats = stamps.repeats(header_ns) && now == before;
    before = now;
    if (repeats) {
      ++repeated;
      return;
    }
    out.left_out.guard([&] {
      stamps.chosen(header_ns, origin.record_ns, origin.where);
      stamps.add(header_ns, origin.record_ns);
      numbers.push_back(origin.number);
    });
  });
  if (out.left_out_as_map(reading)) return out;
  keep_in_order(bag, topic, stamps, numbers, out);
  const std::int64_t given_ns = reading.sweeps.device.sweep_period_ns;
  out.period_ns = given_ns > 0 ? given_ns : median_step_ns(out.stamps);
  out.remark = stamps.remark();
  if (repeated > 0) out.remark += (out.remark.empty() ? "" : "; ") + repeats_text(repeated);
  out.follow_records = !stamps.other_clock();
  out.record_lag_ns = stamps.lag_ns().first;
  if (reading.stamps == StampSource::record) {
    for (auto& start : out.starts) {
      if (start) *start -= out.period_ns;
    }
    out.remark +=
        fmt::format("{}the import assumes that each sweep starts {} s (one sweep period) before its record stamp",
                    out.remark.empty() ? "" : "; ", std::to_string(1e-9 * static_cast<double>(out.period_ns)));
  }
  return out;
}

BuiltSweeps read_lidar(const OpenedBag& bag, SensorMountings& places, const std::string& topic,
                       const CloudHeaders& headers, const BagReading& reading, std::vector<std::string>& notes) {
  SweepReading sweeps = reading.sweeps;
  sweeps.device.name = reading.for_odometry ? topic : sensor_name(topic);
  SweepBuilder builder(std::move(sweeps), headers.period_ns, headers.left_out);
  double clocks_apart_s = 0.0;
  std::vector<std::int64_t> records;
  LeftOut counted_in_headers("clouds");
  read_clouds(bag, topic, counted_in_headers, [&]<class Message>(const Message& message, const MessageOrigin& origin) {
    if (origin.number >= headers.starts.size())
      throw BadInput(fmt::format(
          "{}: the frame_id of this point cloud differs from the frame_id of the previous point cloud", origin.where));
    const std::optional<std::int64_t> start_ns = headers.starts[origin.number];
    if (!start_ns) return;
    if constexpr (std::is_same_v<Message, ros::LivoxCustomMsg>) {
      const double apart_ns = static_cast<double>(message.timebase) - static_cast<double>(stamp_of(message.header));
      clocks_apart_s = std::max(clocks_apart_s, 1e-9 * std::abs(apart_ns));
    }
    std::optional<Cloud> cloud;
    builder.left_out().guard([&] { cloud = cloud_of(message, origin.where); });
    if (!cloud) return;
    records.push_back(origin.record_ns);
    builder.add(start_ns, std::move(*cloud), origin.where);
  });
  std::vector<std::string> own;
  BuiltSweeps built = builder.finish(bag.place + ": topic " + topic, own);
  for (std::string& note : own) notes.push_back(topic + ": " + note);
  if (!headers.remark.empty()) notes.push_back(topic + ": " + headers.remark);
  if (reading.stamps == StampSource::header && headers.follow_records)
    note_points_to_come(topic, built, records, notes);
  if (clocks_apart_s > kClocksApart_s) {
    notes.push_back(
        fmt::format("{}: caution: the timebase and the header stamp of the messages differ by up to {} s; the import "
                    "counts the point times from the header stamp",
                    topic, std::to_string(clocks_apart_s)));
  }
  built.record_lag_ns = headers.record_lag_ns - headers.period_ns;
  places.place(topic, headers.frame, "--T-body-lidar", reading.lidar_placed, built.lidar.T_BL, notes);
  return built;
}

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
    throw BadInput(
        fmt::format("{}: the cloud has {} x {} points of {} bytes each and {} bytes of data. The sizes contradict each "
                    "other, or the layout is not supported: {}",
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
