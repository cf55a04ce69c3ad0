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

sim::LidarRecord PointStore::sweep(const sim::LidarRecord& lidar, std::size_t sweep) const {
  const std::uint64_t first = lidar.sweep_first[sweep], last = lidar.sweep_first[sweep + 1];
  sim::LidarRecord out;
  out.name = lidar.name;
  out.device = lidar.device;
  out.T_BL = lidar.T_BL;
  out.sweep_period_ns = lidar.sweep_period_ns;
  out.point_times = lidar.point_times;
  out.sweep_start_ns = {lidar.sweep_start_ns[sweep]};
  out.sweep_first = {0, last - first};
  out.position_L_m = position_L_m.rows(first, last);
  out.range_m = range_m.rows(first, last);
  out.intensity = intensity.rows(first, last);
  out.offset_ns = offset_ns.rows(first, last);
  out.ring = ring.rows(first, last);
  return out;
}

}  // namespace tumble::scenarios
