// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/recovered_rates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"

namespace tumble::scenarios {

namespace {

/// Returns true if a gyro reading can be compared with the rate of rate/tumble.
using Stands = bool (*)(const RateState&);

bool does_not_clip(const RateState& rate) {
  return rate.clipped_axes == 0;
}

/// Returns true if a gyro reading neither clips nor is suspect. A plateau without a clear saturation limit is suspect.
bool is_read(const RateState& rate) {
  return does_not_clip(rate) && rate.source == RateSource::measured;
}

/// Returns the gyro bias: the mean difference between readings and the smoother's bias-free rates, over samples that
/// satisfy `stands`.
Eigen::Vector3d bias_rad_s(const std::vector<ImuSample>& samples, const std::vector<RateState>& rates, Stands stands) {
  double free = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!stands(rates[k])) continue;
    free += 1.0;
    bias += (samples[k].angular_velocity_rad_s - rates[k].w_WI_I_rad_s - bias) / free;
  }
  return bias;
}

/// Rates of rate/tumble that replace readings. The rates are empty if nothing clips or the smoother failed.
struct Recovery {
  std::vector<RateState> rates;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  CarriedBody carried;

  void put(std::size_t k, std::vector<ImuSample>& samples, std::vector<Eigen::Matrix3d>& covariances_rad2_s2) const {
    samples[k].angular_velocity_rad_s = rates[k].w_WI_I_rad_s + bias_rad_s;
    covariances_rad2_s2[k] = rates[k].covariance_rad2_s2;
  }
};

Recovery recovery_of(const sim::Sensors& sensors, const std::vector<ImuSample>& samples, Stands stands,
                     std::map<std::string, double>& health) {
  Recovery out;
  const std::vector<ClipSigns> signs = find_clipped(sensors.imus.front(), samples, health).signs;
  const auto clips = [](const ClipSigns& sign) { return sign.gyro != std::array<std::int8_t, 3>{}; };
  if (std::none_of(signs.begin(), signs.end(), clips)) return out;
  const RateSmoother::Params params = stated_params(sensors.imus.front(), rate_tumble_settings().defaults());
  Estimate of_rates;
  SmoothedRates smoothed;
  if (!tumble_rates(sensors, samples, params, smoothed, of_rates).ok()) return out;
  out.carried = smoothed.carried;
  out.bias_rad_s = bias_rad_s(samples, smoothed.rates, stands);
  out.rates = std::move(smoothed.rates);
  return out;
}

RecoveredRates recover(const Recovery& recovery, Stands stands, std::vector<ImuSample>& samples,
                       std::map<std::string, double>& health) {
  RecoveredRates out;
  out.covariances_rad2_s2.assign(samples.size(), Eigen::Matrix3d::Zero());
  out.sources.assign(samples.size(), RateSource::measured);
  out.carried = recovery.carried;
  out.answered = !recovery.rates.empty();
  if (!out.answered) return out;
  double recovered = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out.sources[k] = recovery.rates[k].source;
    if (stands(recovery.rates[k])) continue;
    recovery.put(k, samples, out.covariances_rad2_s2);
    recovered += 1.0;
  }
  health["samples_recovered"] = recovered;
  return out;
}

}  // namespace

RecoveredRates recover_clipped(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health) {
  return recover(recovery_of(sensors, samples, does_not_clip, health), does_not_clip, samples, health);
}

RecoveredRates recover_in_time(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health) {
  const Recovery recovery = recovery_of(sensors, samples, is_read, health);
  std::vector<std::uint8_t> hidden(samples.size(), 0);
  for (std::size_t k = 0; k < recovery.rates.size(); ++k) hidden[k] = is_read(recovery.rates[k]) ? 0 : 1;
  const std::vector<std::optional<InterpolatedRate>> interpolated = rates_between_readings(samples, hidden);
  RecoveredRates out = recover(recovery, is_read, samples, health);
  for (std::size_t k = 0; k < interpolated.size(); ++k) {
    if (interpolated[k]) {
      samples[k].angular_velocity_rad_s = interpolated[k]->rate_rad_s;
      out.covariances_rad2_s2[k].setZero();
    } else if (!recovery.rates.empty()) {
      recovery.put(k, samples, out.covariances_rad2_s2);
    }
  }
  return out;
}

}  // namespace tumble::scenarios
