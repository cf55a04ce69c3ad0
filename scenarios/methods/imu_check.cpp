// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_check.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

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

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

void report_level(std::size_t axis, double level_rad_s, std::map<std::string, double>& health) {
  health[std::string("gyro_limit_") + kAxes[axis] + "_rad_s"] = level_rad_s;
}

void report_smoother(const AngularRateReport& report, std::map<std::string, double>& health) {
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
  health["calibration_mahalanobis"] = report.calibration_mahalanobis;
  health["calibration_at_prior"] = report.calibration_at_prior ? 1.0 : 0.0;
  health["readings_missing"] = static_cast<double>(report.missing_readings);
  health["gyro_axes_beyond_stated_range"] = static_cast<double>(
      std::count(report.contradicts_stated_range.begin(), report.contradicts_stated_range.end(), true));
  health["accel_delay_s"] = report.sensor_errors.errors.accel_delay_s;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    health[std::string("lever_arm_") + kAxes[axis] + "_m"] =
        report.calibration.constants.lever_arm_m[static_cast<Eigen::Index>(axis)];
    if (report.saturation_limit_observed[axis]) report_level(axis, *report.saturation_limits[axis], health);
  }
}

}  // namespace

void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health) {
  const SaturationPlanes in_use = rails.saturation_planes_in_use();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double level_rad_s = rails.axis_limit_state.channels[axis].plateau_limit;
    if (in_use.sensing_axis[axis]) {
      report_level(axis, in_use.sensing_axis[axis]->saturation_limit_rad_s, health);
    } else if (level_rad_s > 0.0) {
      report_level(axis, level_rad_s, health);
    }
  }
}

std::optional<double> carried_share(const MotionRegimeSmoother::Report& report) {
  return report.regimes_estimated ? std::optional(report.probabilities.hand_held) : std::nullopt;
}

void report_rates(const MotionRegimeSmoother::Report& report, Estimate& result) {
  report_smoother(report.rate, result.health);
  if (!report.regimes_estimated) return;
  result.health["hand_held_smoother_ran"] = report.hand_held_smoother_ran ? 1.0 : 0.0;
  if (report.hand_held_smoother_ran) result.health["hand_held_converged"] = report.hand_held.converged ? 1.0 : 0.0;
}

void report_gaps(std::span<const ImuSample> samples, Estimate& estimate) {
  const auto is_gap = [](const ImuSample& before, const ImuSample& after) {
    return seconds(after.time_ns - before.time_ns) > bridge::kGapMaxS;
  };
  std::size_t gaps = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) gaps += is_gap(samples[k - 1], samples[k]) ? 1 : 0;
  if (gaps > 0) estimate.health["gaps"] = static_cast<double>(gaps);
}

}  // namespace tumble::scenarios
