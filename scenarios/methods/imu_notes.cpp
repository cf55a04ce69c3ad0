// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_notes.hpp"

#include "scenarios/methods/bridge.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

namespace tumble::scenarios {

std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2) {
  std::vector<ImuSample> samples;
  if (!bridge::imu_samples(imu, samples).ok()) return "";
  const SensorHealth health = check_readings({.gyro_range_rad_s = imu.stated_gyro_range_rad_s,
                                              .accel_range_m_s2 = imu.stated_accel_range_m_s2,
                                              .gravity_m_s2 = gravity_m_s2},
                                             samples);
  if (health.ok()) return "";
  HealthFinding finding = health.findings.front();
  finding.sensor.clear();
  return "caution: " + to_text(finding);
}

std::vector<std::string> imu_notes(const Imported& recording) {
  std::vector<std::string> out;
  for (const sim::ImuRecord& imu : recording.sensors.imus) {
    const std::string note = imu_note(imu, recording.sensors.gravity_m_s2);
    if (!note.empty()) out.push_back(imu.name + ": " + note);
  }
  return out;
}

}  // namespace tumble::scenarios
