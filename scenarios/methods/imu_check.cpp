// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_check.hpp"

#include "scenarios/methods/bridge.hpp"

namespace tumble::scenarios {

ImuDescription checked_imu(const sim::Sensors& sensors) {
  const sim::ImuRecord& record = sensors.imus.front();
  return {.gyro_range_rad_s = record.stated_gyro_range_rad_s,
          .accel_range_m_s2 = record.stated_accel_range_m_s2,
          .gravity_m_s2 = sensors.gravity_m_s2,
          .lever_arm_I_m = bridge::lever_arm_I_m(record),
          .is_merged = sensors.sphere_radius_m > 0.0};
}

void report_findings(const SensorHealth& health, const sim::Sensors& sensors, Estimate& estimate) {
  add_findings(health, {&sensors.imus.front().name, 1}, estimate);
}

ImuHealthReport check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                          std::span<const AngularRateState> rates, std::optional<double> carried_share,
                          Estimate& estimate) {
  ImuHealthReport out = check_recording(checked_imu(sensors), samples, rates, carried_share);
  report_findings(out.health, sensors, estimate);
  return out;
}

void inflate_rates(const ImuHealthReport& findings, std::span<const ImuSample> samples, Estimate& estimate) {
  estimate.suspect_rad2_s2 = suspected_error_covariance(findings, samples, estimate.rates);
  for (std::size_t k = 0; k < estimate.suspect_rad2_s2.size(); ++k)
    estimate.rates[k].covariance_rad2_s2 += estimate.suspect_rad2_s2[k];
}

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
