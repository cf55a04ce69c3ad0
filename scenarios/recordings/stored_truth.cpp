// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/stored_truth.hpp"

namespace tumble::scenarios {

sim::Truth StoredTruth::states(std::size_t first, std::size_t last) const {
  sim::Truth out;
  out.period_ns = period_ns;
  out.p_WB_m = p_WB_m.rows(first, last);
  out.q_WB = q_WB.rows(first, last);
  out.v_WB_m_s = v_WB_m_s.rows(first, last);
  out.w_WB_B_rad_s = w_WB_B_rad_s.rows(first, last);
  out.p_BG_m = p_BG_m;
  for (const StoredImuTruth& imu : imus) {
    out.imus.emplace_back();
    out.imus.back().name = imu.name;
    out.imus.back().T_BI = imu.T_BI;
  }
  for (const StoredLidarTruth& lidar : lidars) {
    out.lidars.emplace_back();
    out.lidars.back().name = lidar.name;
    out.lidars.back().T_BL = lidar.T_BL;
  }
  for (const sim::SeriesTruth& each : series) out.series.push_back({each.name, each.T_BX, {}});
  return out;
}

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
