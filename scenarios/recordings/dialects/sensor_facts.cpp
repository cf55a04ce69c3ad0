// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/sensor_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace tumble::scenarios {

namespace {

constexpr double kStillRate_rad_s = 0.2, kStillForce_m_s2 = 1.0;
/// Distance from the lidar to the farthest corner of the rig's bounding box (-0.5 -0.4 -0.27) to (0.5 0.4 0.23) m,
/// rounded up.
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

struct Sweeps {
  const sim::LidarRecord& lidar;
  const PointStore* aside;

  template <class Take>
  void for_each(Take&& take) const {
    for (std::size_t k = 0; k < lidar.sweep_start_ns.size(); ++k) take(sweep_alone(lidar, aside, k));
  }
};

template <class Take>
void for_steps(const Sweeps& sweeps, Take&& take) {
  sweeps.for_each([&](const sim::LidarRecord& sweep) {
    std::map<std::uint16_t, std::uint32_t> last;
    for (std::size_t k = 0; k < sweep.ring.size(); ++k) {
      const auto [before, first] = last.try_emplace(sweep.ring[k], sweep.offset_ns[k]);
      if (!first && sweep.offset_ns[k] > before->second) take(sweep.offset_ns[k] - before->second);
      before->second = sweep.offset_ns[k];
    }
  });
}

std::uint32_t middle_of(const std::vector<std::uint64_t>& counts, std::uint64_t place, std::uint64_t& below) {
  std::uint32_t value = 0;
  for (; value + 1 < counts.size() && below + counts[value] <= place; ++value) below += counts[value];
  return value;
}

int columns_of(const Sweeps& sweeps) {
  constexpr std::uint32_t kHalf_bits = 16, kLower = 0xffff;
  std::vector<std::uint64_t> counts(std::size_t{1} << kHalf_bits, 0);
  std::uint64_t steps = 0, below = 0;
  for_steps(sweeps, [&](std::uint32_t step) { ++counts[step >> kHalf_bits], ++steps; });
  if (steps == 0) return 1;
  const std::uint32_t upper = middle_of(counts, steps / 2, below);
  counts.assign(counts.size(), 0);
  for_steps(sweeps, [&](std::uint32_t step) {
    if (step >> kHalf_bits == upper) ++counts[step & kLower];
  });
  const std::uint32_t median = upper << kHalf_bits | middle_of(counts, steps / 2, below);
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(sweeps.lidar.sweep_period_ns) / median)));
}

LidarFacts facts_of(const Sweeps& sweeps, const std::string& robot) {
  const sim::LidarRecord& lidar = sweeps.lidar;
  LidarFacts out;
  out.device = lidar.device;
  out.livox = is_livox(lidar.device);
  out.timed = lidar.point_times == sim::PointTimes::measured;
  out.sweeps = lidar.sweep_start_ns.size();
  out.period_s = static_cast<double>(lidar.sweep_period_ns) * 1e-9;
  sweeps.for_each([&](const sim::LidarRecord& sweep) {
    if (sweep.range_m.empty()) {
      ++out.empty_sweeps;
      return;
    }
    const auto [nearest, farthest] = std::minmax_element(sweep.range_m.begin(), sweep.range_m.end());
    out.nearest_m = out.points == 0 ? *nearest : std::min<double>(out.nearest_m, *nearest);
    out.farthest_m = out.points == 0 ? *farthest : std::max<double>(out.farthest_m, *farthest);
    out.rings = std::max(out.rings, 1 + *std::max_element(sweep.ring.begin(), sweep.ring.end()));
    out.points += sweep.range_m.size();
  });
  if (out.timed) out.columns = columns_of(sweeps);
  out.own_body_m = robot == "rig" ? kRigCage_m : std::floor(10.0 * out.nearest_m) / 10.0;
  return out;
}

}  // namespace

SensorFacts facts_of(const sim::Sensors& sensors, const std::vector<PointStore>* points) {
  SensorFacts out;
  out.gravity_m_s2 = sensors.gravity_m_s2;
  if (!sensors.imus.empty()) {
    out.imu = facts_of(sensors.imus.front(), sensors.gravity_m_s2);
    out.T_BI = sensors.imus.front().T_BI;
  }
  if (!sensors.lidars.empty()) {
    out.lidar = facts_of(Sweeps{sensors.lidars.front(), points != nullptr ? &points->front() : nullptr}, sensors.robot);
    out.T_BL = sensors.lidars.front().T_BL;
  }
  return out;
}

}  // namespace tumble::scenarios
