// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_check.hpp"

#include <cmath>
#include <string>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/rounded_stamps.hpp"

namespace tumble::scenarios {

namespace {

void report_readings(const ImuFindings::Readings& readings, Estimate& estimate) {
  estimate.health["imu_rest_force_share"] = readings.rest_force_ratio;
  estimate.health["imu_force_share"] = readings.force_ratio;
  estimate.health["imu_rotation_unexplained"] = readings.unexplained_rotation_ratio;
  estimate.health["imu_rotation_slope"] = readings.rotation_slope;
  estimate.health["imu_rotation_agreement"] = readings.rotation_agreement;
  if (readings.frozen_s > 0.0) estimate.health["imu_frozen_s"] = readings.frozen_s;
  const auto& labels = readings.better_axis_labels;
  if (!labels) return;
  constexpr const char* kKeys[] = {"imu_accel_x_is", "imu_accel_y_is", "imu_accel_z_is"};
  for (std::size_t j = 0; j < 3; ++j) estimate.health[kKeys[labels->axis[j]]] = labels->sign[j] * (1.0 + double(j));
  if (labels->gyro_flipped) estimate.health["imu_gyro_flipped"] = 1.0;
}

void report_quantities(const ImuFindings& findings, Estimate& estimate) {
  if (findings.readings) report_readings(*findings.readings, estimate);
  if (findings.rests) {
    estimate.health["rest_gravity_missed_rad"] = findings.rests->angle_error_rad;
    estimate.health["rest_gravity_missed_sigma_rad"] = findings.rests->angle_error_sigma_rad;
    estimate.health["rest_velocity_share"] = findings.rests->velocity_error_ratio;
    estimate.health["rest_velocity_allowed_share"] = findings.rests->velocity_error_ratio_max;
  }
  if (!findings.pivots) return;
  estimate.health["pivot_evidence"] = findings.pivots->evidence;
  estimate.health["pivot_segments"] = static_cast<double>(findings.pivots->compared_segments);
  if (!std::isfinite(findings.pivots->scale_sigma)) return;
  estimate.health["pivot_scale"] = findings.pivots->scale;
  estimate.health["pivot_scale_sigma"] = findings.pivots->scale_sigma;
}

}  // namespace

CheckedImu checked_imu(const sim::Sensors& sensors) {
  const sim::ImuRecord& record = sensors.imus.front();
  return {.gyro_range_rad_s = record.stated_gyro_range_rad_s,
          .accel_range_m_s2 = record.stated_accel_range_m_s2,
          .gravity_m_s2 = sensors.gravity_m_s2,
          .lever_arm_I_m = bridge::lever_arm_I_m(record),
          .merged = sensors.sphere_radius_m > 0.0};
}

void report_findings(const ImuFindings& findings, const sim::Sensors& sensors, Estimate& estimate) {
  report_quantities(findings, estimate);
  add_findings(findings.health, {&sensors.imus.front().name, 1}, estimate);
}

void report_merged(const MergedFindings& merged, std::span<const std::string> names, Estimate& estimate) {
  report_quantities(merged.findings, estimate);
  if (merged.merged.mislabelled_axes) estimate.health["imu_other_axes_share"] = merged.merged.mislabelled_axes->share;
  if (merged.merged.lever_arm_agreement) estimate.health["imu_arm_share"] = *merged.merged.lever_arm_agreement;
  add_findings(merged.findings.health, names, estimate);
}

void report_stamps(const sim::Sensors& sensors, Estimate& estimate) {
  constexpr double kRounding_s = 1e-3;
  const sim::ImuRecord& imu = sensors.imus.front();
  if (!are_rounded(imu.time_ns)) return;
  SensorHealth health;
  health.add(
      HealthFinding::Kind::rounded_stamps,
      {ErrorCode::out_of_range, "step in s to which the time stamps are rounded", kRounding_s, seconds(imu.period_ns)},
      imu.name);
  add_finding(health.findings.front(), estimate);
}

void check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate) {
  report_findings(check_readings(checked_imu(sensors), samples), sensors, estimate);
  report_stamps(sensors, estimate);
}

void inflate_rates(const ImuFindings& findings, std::span<const ImuSample> samples, Estimate& estimate) {
  estimate.suspect_rad2_s2 = suspect_covariance(findings, samples, estimate.rates);
  for (std::size_t k = 0; k < estimate.suspect_rad2_s2.size(); ++k)
    estimate.rates[k].covariance_rad2_s2 += estimate.suspect_rad2_s2[k];
  report_inflated(findings, estimate);
}

void report_inflated(const ImuFindings& findings, Estimate& estimate) {
  if (findings.health.invalidates_estimate()) estimate.health["imu_rates_doubted"] = 1.0;
}

}  // namespace tumble::scenarios
