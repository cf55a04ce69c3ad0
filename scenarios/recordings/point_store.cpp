// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/point_store.hpp"

namespace tumble::scenarios {

void PointStore::take(sim::LidarRecord& record) {
  const auto move = [](auto& rows, auto& column) {
    column.append(std::span(std::as_const(rows)));
    rows.clear();
  };
  move(record.position_L_m, position_L_m);
  move(record.range_m, range_m);
  move(record.intensity, intensity);
  move(record.offset_ns, offset_ns);
  move(record.ring, ring);
}

namespace {

template <class Row>
std::vector<Row> segment(const std::vector<Row>& rows, std::size_t first, std::size_t last) {
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(last - first)};
}

template <class Row>
std::vector<Row> segment(const ColumnFile<Row>& rows, std::size_t first, std::size_t last) {
  return rows.rows(first, last);
}

template <class Points>
void take_points(const Points& points, std::size_t first, std::size_t last, sim::LidarRecord& out) {
  out.position_L_m = segment(points.position_L_m, first, last);
  out.range_m = segment(points.range_m, first, last);
  out.intensity = segment(points.intensity, first, last);
  out.offset_ns = segment(points.offset_ns, first, last);
  out.ring = segment(points.ring, first, last);
}

}  // namespace

sim::LidarRecord sweep_alone(const sim::LidarRecord& lidar, const PointStore* aside, std::size_t sweep) {
  const std::uint64_t first = lidar.sweep_first[sweep], last = lidar.sweep_first[sweep + 1];
  sim::LidarRecord out;
  out.name = lidar.name;
  out.device = lidar.device;
  out.T_BL = lidar.T_BL;
  out.sweep_period_ns = lidar.sweep_period_ns;
  out.point_times = lidar.point_times;
  out.sweep_start_ns = {lidar.sweep_start_ns[sweep]};
  out.sweep_first = {0, last - first};
  if (aside != nullptr)
    take_points(*aside, first, last, out);
  else
    take_points(lidar, first, last, out);
  return out;
}

}  // namespace tumble::scenarios
