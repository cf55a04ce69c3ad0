// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/point_cloud.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tumble::ros {

namespace {

struct TimeUnit {
  std::string_view suffix;
  double ns;
};
constexpr std::array<TimeUnit, 4> kUnits = {{{"_s", 1e9}, {"_ms", 1e6}, {"_us", 1e3}, {"_ns", 1.0}}};
constexpr std::array<std::string_view, 8> kTimeNames = {"t",          "time",        "timestamp",   "timestamps",
                                                        "time_stamp", "offset_time", "time_offset", "offset"};
constexpr std::array<std::string_view, 2> kIntensityNames = {"intensity", "reflectivity"};
constexpr std::array<std::string_view, 3> kRingNames = {"ring", "line", "channel"};
constexpr double kSpanMin_ns = 1e6, kSpanMax_ns = 1e9;  // times of a sweep
constexpr std::size_t kPointsForUnit = 100;             // fewer points may span a small part of the sweep
constexpr double kOtherClock_ns = 1e9;
constexpr std::array<std::uint8_t, 9> kBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};  // of the datatypes of PointField

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// Returns the unit in ns that the suffix of a lower-case name states, or 0.
double stated_unit_ns(std::string_view name) {
  const auto* found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const TimeUnit& unit) { return name.ends_with(unit.suffix); });
  return found == kUnits.end() ? 0.0 : found->ns;
}

bool is_time_name(std::string_view name) {
  const auto among = [](std::string_view text) {
    return std::find(kTimeNames.begin(), kTimeNames.end(), text) != kTimeNames.end();
  };
  return among(name) || (stated_unit_ns(name) > 0.0 && among(name.substr(0, name.rfind('_'))));
}

template <class Number>
double number_at(const std::uint8_t* at) {
  Number value;
  std::memcpy(&value, at, sizeof(value));
  return static_cast<double>(value);
}

double number_at(const std::uint8_t* at, std::uint8_t datatype) {
  switch (datatype) {
    case 1:
      return number_at<std::int8_t>(at);
    case 2:
      return number_at<std::uint8_t>(at);
    case 3:
      return number_at<std::int16_t>(at);
    case 4:
      return number_at<std::uint16_t>(at);
    case 5:
      return number_at<std::int32_t>(at);
    case 6:
      return number_at<std::uint32_t>(at);
    case 7:
      return number_at<float>(at);
    default:
      return number_at<double>(at);
  }
}

Status check_layout(const PointCloudView& cloud, std::size_t row_bytes) {
  if (cloud.is_bigendian) return {ErrorCode::out_of_range, "is_bigendian", 1.0, 0.0};
  if (cloud.width == 0 || cloud.height == 0) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (cloud.point_step == 0) return {ErrorCode::out_of_range, "point_step", 0.0, 1.0};
  if (row_bytes > cloud.data.size() / cloud.height) {
    return {ErrorCode::out_of_range, "row_step", static_cast<double>(row_bytes),
            static_cast<double>(cloud.data.size()) / cloud.height};
  }
  return {};
}

/// Scales intensities to 0..1.
void scale_intensity(std::vector<LidarPoint>& points) {
  float largest = 0.0f;
  for (const LidarPoint& point : points) largest = std::max(largest, point.intensity);
  if (!(largest > 1.0f)) return;
  const float scale = 1.0f / std::max(255.0f, largest);
  for (LidarPoint& point : points) point.intensity *= scale;
}

}  // namespace

struct PointCloudReader::Layout {
  const PointField* axes[3] = {};
  const PointField* intensity = nullptr;
  const PointField* ring = nullptr;
  const PointField* time = nullptr;
};

Status PointCloudReader::find_fields(const PointCloudView& cloud, Layout& layout) const {
  double times = 0.0;
  for (const PointField& field : cloud.fields) {
    if (field.datatype < 1 || field.datatype > 8 || field.count > 1) continue;  // count 0: some drivers mean one
    if (std::uint64_t{field.offset} + kBytes[field.datatype] > cloud.point_step)
      return {ErrorCode::out_of_range, "field offset", double(field.offset), double(cloud.point_step)};
    const std::string name = lower(field.name);
    const auto among = [&](const auto& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
    if (name == "x" || name == "y" || name == "z") layout.axes[name[0] - 'x'] = &field;
    if (among(kIntensityNames)) layout.intensity = &field;
    if (among(kRingNames)) layout.ring = &field;
    if (!time_field_.empty() ? field.name != time_field_ : !is_time_name(name)) continue;
    const bool states = stated_unit_ns(name) > 0.0;
    const bool stated = layout.time != nullptr && stated_unit_ns(lower(layout.time->name)) > 0.0;
    if (layout.time == nullptr || (states && !stated)) {
      layout.time = &field;
      times = 1.0;
    } else if (states == stated) {
      ++times;
    }
  }
  for (const PointField* axis : layout.axes)
    if (axis == nullptr) return {ErrorCode::empty, "field x, y or z", 0.0, 1.0};
  if (layout.time == nullptr) return {ErrorCode::empty, "field of point times", 0.0, 1.0};
  if (times > 1.0) return {ErrorCode::out_of_range, "fields of point times", times, 1.0};
  return {};
}

Status PointCloudReader::find_unit(double span, std::size_t points) {
  if (!(span > 0.0)) return {ErrorCode::degenerate, "span of point times", span, 0.0};
  if (unit_ns_ == 0.0) {
    if (points < kPointsForUnit) return {ErrorCode::too_few, "points", double(points), double(kPointsForUnit)};
    for (const TimeUnit& unit : kUnits)
      if (span * unit.ns >= kSpanMin_ns && span * unit.ns < kSpanMax_ns) unit_ns_ = unit.ns;
  }
  if (unit_ns_ == 0.0 || span * unit_ns_ > kSpanMax_ns) {
    return {ErrorCode::out_of_range, "span of point times", span,
            unit_ns_ > 0.0 ? kSpanMax_ns / unit_ns_ : kSpanMax_ns};
  }
  return {};
}

void PointCloudReader::set_times(TimeNs stamp_ns, double first, double last, TimedSweep& sweep) const {
  const auto in_ns = [&](double time) { return std::llround(static_cast<long double>(time) * unit_ns_); };
  const double from_zero_ns = std::abs(first * unit_ns_);
  const double from_stamp_ns = std::abs(first * unit_ns_ - static_cast<double>(stamp_ns));
  if (std::min(from_zero_ns, from_stamp_ns) > kOtherClock_ns) {
    sweep.start_ns = stamp_ns;
  } else {
    sweep.start_ns = from_stamp_ns < from_zero_ns ? in_ns(first) : stamp_ns + in_ns(first);
  }
  sweep.end_ns = sweep.start_ns + std::llround((last - first) * unit_ns_);
  for (std::size_t i = 0; i < times_.size(); ++i)
    sweep.points[i].offset_ns = static_cast<std::uint32_t>(std::llround((times_[i] - first) * unit_ns_));
}

Status PointCloudReader::read(const PointCloudView& cloud, TimedSweep& sweep) {
  const std::size_t row_bytes = std::max<std::uint64_t>(cloud.row_step, std::uint64_t{cloud.width} * cloud.point_step);
  Layout layout;
  if (Status status = check_layout(cloud, row_bytes); !status.ok()) return status;
  if (Status status = find_fields(cloud, layout); !status.ok()) return status;
  sweep.points.clear();
  times_.clear();
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    for (std::uint32_t column = 0; column < cloud.width; ++column) {
      const std::uint8_t* const point = cloud.data.data() + row * row_bytes + std::size_t{column} * cloud.point_step;
      const auto number = [&](const PointField* field) {
        return field == nullptr ? 0.0 : number_at(point + field->offset, field->datatype);
      };
      const Eigen::Vector3d position(number(layout.axes[0]), number(layout.axes[1]), number(layout.axes[2]));
      const double time = number(layout.time);
      if (!position.allFinite() || position.isZero(0.0) || !std::isfinite(time)) continue;
      first = std::min(first, time);
      last = std::max(last, time);
      times_.push_back(time);
      LidarPoint& added = sweep.points.emplace_back();
      added.position_L_m = position.cast<float>();
      added.intensity = static_cast<float>(std::max(0.0, number(layout.intensity)));
      added.ring = static_cast<std::uint16_t>(std::fmin(std::fmax(number(layout.ring), 0.0), 65535.0));
    }
  }
  if (sweep.points.empty()) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (unit_ns_ == 0.0) unit_ns_ = stated_unit_ns(lower(layout.time->name));
  if (Status status = find_unit(last - first, sweep.points.size()); !status.ok()) return status;
  set_times(cloud.stamp_ns, first, last, sweep);
  scale_intensity(sweep.points);
  return {};
}

}  // namespace tumble::ros
