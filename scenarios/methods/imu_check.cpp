// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/rounded_stamps.hpp"

namespace tumble::scenarios {

namespace {

using FindingKind = ImuFinding::Kind;

constexpr double kArmShareMin = 0.5;  // 1: matches the mountings; 0: no relation; -1: flipped sign
// Largest deviation of ImuMerge::lever_arm_agreement() from 1. A larger deviation indicates a scale error of all IMUs.
// Centripetal force grows with the squared rate, so the limit corresponds to 3 % of gyro scale, three times the data
// sheet's scale error. In runs of `slip` without faults, lever_arm_agreement() was 0.999 to 1.002.
constexpr double kArmShareOff = 0.06;

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

void report_findings(const ImuFindings& findings, const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     Estimate& estimate) {
  report_quantities(findings, estimate);
  for (const ImuFinding& finding : findings.all) {
    if (finding.kind == FindingKind::rate_unit) {
      add_finding({HealthFinding::About::rate_unit}, estimate);
      continue;
    }
    add_finding({HealthFinding::About::readings}, estimate);
    if (finding.kind == FindingKind::flight)
      add_finding({HealthFinding::About::flights, finding.status.value}, estimate);
    if (finding.kind != FindingKind::frozen_axis) continue;
    const HealthFinding frozen{HealthFinding::About::unit_frozen, seconds(finding.since_ns - samples.front().time_ns),
                               sensors.imus.front().name + "_" + to_string(finding.axis)};
    if (!has_finding(frozen, estimate)) add_finding(frozen, estimate);  // keep the earliest time
  }
}

void report_stamps(const sim::Sensors& sensors, Estimate& estimate) {
  if (are_rounded(sensors.imus.front().time_ns)) add_finding({HealthFinding::About::stamps, 1e-3}, estimate);
}

void check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate) {
  report_findings(check_readings(checked_imu(sensors), samples), sensors, samples, estimate);
  report_stamps(sensors, estimate);
}

Status check_imus(const sim::Sensors& sensors, const MergedImus& imus, Estimate& estimate) {
  const MergedRecordings& merged = imus.merged;
  const ImuFindings own = check_readings(checked_imu(sensors), merged.samples);
  report_findings(own, sensors, merged.samples, estimate);
  report_stamps(sensors, estimate);
  if (merged.mislabelled_axes) {
    estimate.health["imu_other_axes_share"] = merged.mislabelled_axes->share;
    add_finding({HealthFinding::About::readings}, estimate);
  }
  const auto contradiction = std::find_if(own.all.begin(), own.all.end(),
                                          [](const auto& each) { return each.kind != FindingKind::rate_unit; });
  const Status status = contradiction == own.all.end() ? Status{} : contradiction->status;
  if (!merged.lever_arm_agreement) return status;
  estimate.health["imu_arm_share"] = *merged.lever_arm_agreement;
  if (std::abs(*merged.lever_arm_agreement - 1.0) > kArmShareOff && !own.readings->confirms_gyro())
    add_finding({HealthFinding::About::readings}, estimate);
  if (!status.ok() || *merged.lever_arm_agreement >= kArmShareMin) return status;
  add_finding({HealthFinding::About::readings}, estimate);
  return {ErrorCode::out_of_range,
          "difference between the specific forces of two IMUs, compared with the difference predicted from rotation "
          "and lever arms",
          *merged.lever_arm_agreement, kArmShareMin};
}

void inflate_rates(const ImuFindings& findings, std::span<const ImuSample> samples, Estimate& estimate) {
  estimate.suspect_rad2_s2 = suspect_covariance(findings, samples, estimate.rates);
  for (std::size_t k = 0; k < estimate.suspect_rad2_s2.size(); ++k)
    estimate.rates[k].covariance_rad2_s2 += estimate.suspect_rad2_s2[k];
  if (findings.contradict()) add_finding({HealthFinding::About::rates}, estimate);
}

}  // namespace tumble::scenarios
