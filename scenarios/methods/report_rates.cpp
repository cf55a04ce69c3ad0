// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/report_rates.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/report_rails.hpp"

namespace tumble::scenarios {

namespace {

void report_smoother(const RateReport& report, Estimate& result) {
  std::map<std::string, double>& health = result.health;
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
  health["restarts"] = report.restarts;
  health["calibration_mahalanobis"] = report.calibration_mahalanobis;
  health["calibration_at_prior"] = report.calibration_at_prior ? 1.0 : 0.0;
  health["flight_share"] = report.flight_share;
  health["readings_missing"] = static_cast<double>(report.missing_readings);
  health["rails_disagreeing"] = static_cast<double>(
      std::count(report.contradicts_stated_range.begin(), report.contradicts_stated_range.end(), true));
  constexpr int kDelay = SensorErrors::kDelay;
  health["accel_delay_s"] = report.sensor_errors.errors.accel_delay_s;
  health["accel_delay_sigma_s"] = std::sqrt(report.sensor_errors.covariance(kDelay, kDelay));
  health["device_calibrated"] = report.data_sheet_probability;
  health["triads_together"] = report.synchronous_probability;
  health["error_rounds"] = report.error_rounds;
  health["gyro_update_s"] = report.gyro_update_s;
  health["accel_update_s"] = report.accel_update_s;
  health["rails_upright"] = report.clips_after_compensation ? 1.0 : 0.0;
  const char* const names[] = {"x", "y", "z"};
  for (int j = 0; j < 3; ++j) {
    const std::string axis = names[j];
    health["learnt_lever_arm_" + axis + "_m"] = report.calibration.constants.lever_arm_m[j];
    health["learnt_lever_arm_sigma_" + axis + "_m"] = std::sqrt(report.calibration.covariance(j, j));
  }
  report_rails(report, health);
}

}  // namespace

std::optional<double> carried_share(const RegimeSmoother::Report& report) {
  return report.judged ? std::optional(report.probabilities.hand_held) : std::nullopt;
}

void report_rates(const RegimeSmoother::Report& report, Estimate& result) {
  report_smoother(report.rate, result);
  if (!report.judged) return;
  std::map<std::string, double>& health = result.health;
  health["regime_flight_share"] = report.probabilities.flight;
  health["regime_contact_share"] = report.probabilities.contact;
  health["regime_carried_share"] = report.probabilities.hand_held;
  health["regime_carried_clipped_max"] = report.hand_held_probability_max;
  health["regime_carried_asked"] = report.hand_held_smoother_ran ? 1.0 : 0.0;
  if (report.spin_samples > 0) health["regime_spin_samples"] = static_cast<double>(report.spin_samples);
  if (!report.hand_held_smoother_ran) return;
  health["carried_iterations"] = report.hand_held.iterations;
  health["carried_converged"] = report.hand_held.converged ? 1.0 : 0.0;
  health["carried_hand_mahalanobis"] = report.hand_held.hand_acceleration_ratio;
  health["carried_revolutions_asked"] = report.hand_held.revolutions_tested;
  health["carried_revolutions_taken"] = report.hand_held.revolutions_corrected;
  health["carried_revolutions_open"] = report.hand_held.revolutions_ambiguous;
  health["carried_revolutions_failed"] = report.hand_held.revolutions_failed;
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
