// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/sensor_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "scenarios/recordings/upper_median.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kStillRate_rad_s = 0.2, kStillForce_m_s2 = 1.0;
/// The corner of the box (-0.5 -0.4 -0.27) to (0.5 0.4 0.23) m around the rig's lidar, rounded up.
constexpr double kRigCage_m = 0.7;

bool is_livox(const std::string& device) {
  constexpr std::array kLivox = {"mid", "avia", "horizon", "tele", "hap"};
  return std::any_of(kLivox.begin(), kLivox.end(), [&](const char* each) { return device.starts_with(each); });
}

ImuFacts facts_of(const sim::ImuRecord& imu, double gravity_m_s2) {
  ImuFacts out;
  out.device = imu.device;
  out.samples = imu.time_ns.size();
  out.period_s = static_cast<double>(imu.period_ns) * 1e-9;
  out.gyro_noise_rad_s_sqrt_hz = imu.gyro_noise_rad_s_sqrt_hz;
  out.accel_noise_m_s2_sqrt_hz = imu.accel_noise_m_s2_sqrt_hz;
  out.stated_gyro_range_rad_s = imu.stated_gyro_range_rad_s;
  out.stated_accel_range_m_s2 = imu.stated_accel_range_m_s2;
  bool still = true;
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    const Eigen::Vector3d &w = imu.gyro_rad_s[k], &f = imu.accel_m_s2[k];
    out.largest_gyro_rad_s = std::max(out.largest_gyro_rad_s, w.cwiseAbs().maxCoeff());
    out.largest_accel_m_s2 = std::max(out.largest_accel_m_s2, f.cwiseAbs().maxCoeff());
    still = still && w.norm() < kStillRate_rad_s && std::abs(f.norm() - gravity_m_s2) < kStillForce_m_s2;
    if (still) out.still_at_start_s = static_cast<double>(imu.time_ns[k] - imu.time_ns.front()) * 1e-9;
  }
  return out;
}

/// Firings of a ring in a sweep: its period over the median step between returns of one ring.
int columns_of(const sim::LidarRecord& lidar) {
  std::vector<std::uint32_t> steps;
  for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
    std::map<std::uint16_t, std::uint32_t> last;
    for (std::size_t k = lidar.sweep_first[sweep]; k < lidar.sweep_first[sweep + 1]; ++k) {
      const auto [before, first] = last.try_emplace(lidar.ring[k], lidar.offset_ns[k]);
      if (!first && lidar.offset_ns[k] > before->second) steps.push_back(lidar.offset_ns[k] - before->second);
      before->second = lidar.offset_ns[k];
    }
  }
  if (steps.empty()) return 1;
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(lidar.sweep_period_ns) / upper_median(steps))));
}

LidarFacts facts_of(const sim::LidarRecord& lidar, const std::string& robot) {
  LidarFacts out;
  out.device = lidar.device;
  out.livox = is_livox(lidar.device);
  out.timed = lidar.point_times == sim::PointTimes::measured;
  out.sweeps = lidar.sweep_start_ns.size();
  out.points = lidar.range_m.size();
  out.period_s = static_cast<double>(lidar.sweep_period_ns) * 1e-9;
  if (out.points > 0) {
    out.rings = 1 + *std::max_element(lidar.ring.begin(), lidar.ring.end());
    const auto [nearest, farthest] = std::minmax_element(lidar.range_m.begin(), lidar.range_m.end());
    out.nearest_m = *nearest;
    out.farthest_m = *farthest;
  }
  if (out.timed) out.columns = columns_of(lidar);
  out.own_body_m = robot == "rig" ? kRigCage_m : std::floor(10.0 * out.nearest_m) / 10.0;
  return out;
}

}  // namespace

SensorFacts facts_of(const sim::Sensors& sensors) {
  SensorFacts out;
  out.gravity_m_s2 = sensors.gravity_m_s2;
  if (!sensors.imus.empty()) {
    out.imu = facts_of(sensors.imus.front(), sensors.gravity_m_s2);
    out.T_BI = sensors.imus.front().T_BI;
  }
  if (!sensors.lidars.empty()) {
    out.lidar = facts_of(sensors.lidars.front(), sensors.robot);
    out.T_BL = sensors.lidars.front().T_BL;
  }
  return out;
}

}  // namespace tumble::scenarios
