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

constexpr double kSpanMin_ns = 1e6, kSpanMax_ns = 1e9;  // accepted time span of a sweep
constexpr std::size_t kPointsForUnit = 100;             // a cloud with fewer points may cover a small part of the sweep
constexpr double kOtherClock_ns = 1e9;

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
  TimeFieldChoice times;
  for (const PointField& field : cloud.fields) {
    if (!is_number(field)) continue;
    const std::string name = lower_case(field.name);
    const auto among = [&](const auto& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
    if (name == "x" || name == "y" || name == "z") layout.axes[name[0] - 'x'] = &field;
    if (among(kIntensityNames)) layout.intensity = &field;
    if (among(kRingNames)) layout.ring = &field;
    if (time_field_.empty()) times.offer(field.name);
    if (field.name == (time_field_.empty() ? times.field : time_field_)) layout.time = &field;
  }
  for (const PointField* axis : layout.axes)
    if (axis == nullptr) return {ErrorCode::empty, "field x, y or z", 0.0, 1.0};
  if (layout.time == nullptr) return {ErrorCode::empty, "field of point times", 0.0, 1.0};
  if (!times.rival.empty()) return {ErrorCode::out_of_range, "fields of point times", 2.0, 1.0};
  return {};
}

Status PointCloudReader::find_unit(double span, std::size_t points) {
  if (!(span > 0.0)) return {ErrorCode::degenerate, "span of point times", span, 0.0};
  if (unit_ns_ == 0.0) {
    if (points < kPointsForUnit)
      return {ErrorCode::insufficient_data, "points", double(points), double(kPointsForUnit)};
    for (const TimeUnit& unit : kTimeUnits)
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
  const std::size_t row_bytes = cloud.row_bytes();
  Layout layout;
  if (Status status = check_layout(cloud); !status.ok()) return status;
  if (Status status = find_fields(cloud, layout); !status.ok()) return status;
  sweep.points.clear();
  times_.clear();
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    for (std::uint32_t column = 0; column < cloud.width; ++column) {
      const std::uint8_t* const point = cloud.data.data() + row * row_bytes + std::size_t{column} * cloud.point_step;
      const auto number = [&](const PointField* field) { return field == nullptr ? 0.0 : number_at(point, *field); };
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
  if (const TimeUnit* stated = stated_unit(layout.time->name); unit_ns_ == 0.0 && stated) unit_ns_ = stated->ns;
  if (Status status = find_unit(last - first, sweep.points.size()); !status.ok()) return status;
  set_times(cloud.stamp_ns, first, last, sweep);
  scale_intensity(sweep.points);
  return {};
}

}  // namespace tumble::ros
