// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/sweep_check.hpp"

#include <algorithm>
#include <limits>

namespace tumble::mapping {

Status check_time_offsets(TimeNs span_ns, std::span<const LidarPoint> points) {
  for (const LidarPoint& point : points) {
    if (point.offset_ns > span_ns)
      return {ErrorCode::out_of_range, "offset_ns", double(point.offset_ns), double(span_ns)};
  }
  return {};
}

Status check_point_selection(TimeNs span_ns, std::span<const LidarPoint> points, const PointCounts& counts) {
  if (counts.received == 0) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (counts.finite == 0) return {ErrorCode::non_finite, "position_L_m", std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (counts.usable_points == 0) return {ErrorCode::insufficient_data, "points in range", 0.0, 1.0};
  const auto differs = [&](const LidarPoint& point) { return point.offset_ns != points.front().offset_ns; };
  if (span_ns > 0 && points.size() > 1 && std::none_of(points.begin(), points.end(), differs)) {
    return {ErrorCode::degenerate, "spread of offset_ns", 0.0, 1.0};
  }
  return {};
}

}  // namespace tumble::mapping
