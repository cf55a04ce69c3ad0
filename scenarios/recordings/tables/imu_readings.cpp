// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/imu_readings.hpp"

#include <algorithm>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kG_m_s2 = 9.80665;
/// At rest and while rolling or carried the median is near g; in g, mg or raw counts it is not.
constexpr double kLeastMedian_m_s2 = 3.0, kLargestMedian_m_s2 = 30.0;

void require_plausible_force(const std::string& where, const sim::ImuRecord& imu, AccelUnit unit) {
  std::vector<double> norms;
  for (const Eigen::Vector3d& force : imu.accel_m_s2) norms.push_back(force.norm());
  const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
  std::nth_element(norms.begin(), middle, norms.end());
  if (*middle >= kLeastMedian_m_s2 && *middle <= kLargestMedian_m_s2) return;
  const char* read_as = unit == AccelUnit::g ? "g" : "m/s^2";
  throw BadInput(where + ": read in " + read_as + " the median specific force is " + std::to_string(*middle) +
                 " m/s^2, must be within 3 and 30: is the file in " + (unit == AccelUnit::g ? "m/s^2" : "g") + "?");
}

}  // namespace

sim::ImuRecord without_readings(sim::ImuRecord device) {
  for (auto* rows : {&device.gyro_rad_s, &device.accel_m_s2}) rows->clear();
  device.time_ns.clear();
  device.clip_flags.clear();
  return device;
}

void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu) {
  if (!rate_rad_s.allFinite() || !force_m_s2.allFinite()) throw BadInput(where + ": a reading is not finite");
  if (!imu.time_ns.empty() && stamp_ns <= imu.time_ns.back()) {
    throw BadInput(where + ": stamp does not rise: " + std::to_string(stamp_ns - imu.time_ns.front()) +
                   " ns after the first, the one before " + std::to_string(imu.time_ns.back() - imu.time_ns.front()));
  }
  imu.time_ns.push_back(stamp_ns);
  imu.gyro_rad_s.push_back(rate_rad_s);
  imu.accel_m_s2.push_back(force_m_s2);
  imu.clip_flags.push_back(0);
}

void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu) {
  if (imu.time_ns.size() < 2)
    throw BadInput(where + ": holds " + std::to_string(imu.time_ns.size()) + " samples, needs 2");
  require_plausible_force(where, imu, unit);
  imu.period_ns = median_step_ns(imu.time_ns);
}

double scale_of(AccelUnit unit) {
  return unit == AccelUnit::g ? kG_m_s2 : 1.0;
}

}  // namespace tumble::scenarios
