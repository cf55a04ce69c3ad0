// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/recovered_rates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/rate_tumble.hpp"

namespace tumble::scenarios {

namespace {

/// The smoother's rates are without the gyro's bias: the mean difference of the samples that are read.
Eigen::Vector3d bias_rad_s(const std::vector<ImuSample>& samples, const std::vector<RateState>& rates) {
  double free = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rates[k].clipped_axes != 0) continue;
    free += 1.0;
    bias += (samples[k].angular_velocity_rad_s - rates[k].w_WI_I_rad_s - bias) / free;
  }
  return bias;
}

}  // namespace

RecoveredRates recover_clipped(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                               std::map<std::string, double>& health) {
  RecoveredRates out;
  out.covariances_rad2_s2.assign(samples.size(), Eigen::Matrix3d::Zero());
  const std::vector<ClipSigns> signs = find_clipped(sensors.imus.front(), samples).signs;
  const auto clips = [](const ClipSigns& sign) { return sign.gyro != std::array<std::int8_t, 3>{}; };
  if (std::none_of(signs.begin(), signs.end(), clips)) return out;
  const RateSmoother::Params params = stated_params(sensors.imus.front(), rate_tumble_settings().defaults());
  std::vector<RateState> rates;
  std::map<std::string, double> of_rates;
  if (!tumble_rates(sensors, samples, params, rates, of_rates).ok()) return out;
  const auto carried = of_rates.find("regime_carried_clipped_max");
  if (carried != of_rates.end()) out.carried = carried->second;
  const Eigen::Vector3d bias = bias_rad_s(samples, rates);
  double recovered = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rates[k].clipped_axes == 0) continue;
    samples[k].angular_velocity_rad_s = rates[k].w_WI_I_rad_s + bias;
    out.covariances_rad2_s2[k] = rates[k].covariance_rad2_s2;
    recovered += 1.0;
  }
  health["samples_recovered"] = recovered;
  return out;
}

}  // namespace tumble::scenarios
