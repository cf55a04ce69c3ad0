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

}  // namespace tumble::scenarios
