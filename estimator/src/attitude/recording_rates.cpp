// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/recording_rates.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "tumble/angular_velocity/detail/interpolated_rates.hpp"
#include "tumble/attitude/detail/clipped_readings.hpp"

namespace tumble {

namespace {

bool keeps_estimated_rate(const AngularRateState& rate, ReadingsToReplace replaced) {
  return rate.clipped_axes == 0 &&
         (replaced == ReadingsToReplace::clipped || rate.source == AngularRateSource::measured);
}

bool any_clips(std::span<const ClipSigns> signs) {
  return std::any_of(signs.begin(), signs.end(),
                     [](const ClipSigns& sign) { return sign.gyro != std::array<std::int8_t, 3>{}; });
}

Eigen::Vector3d bias_rad_s(std::span<const ImuSample> samples, std::span<const AngularRateState> rates,
                           ReadingsToReplace replaced) {
  double kept = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!keeps_estimated_rate(rates[k], replaced)) continue;
    kept += 1.0;
    bias += (samples[k].angular_velocity_rad_s - rates[k].w_WI_I_rad_s - bias) / kept;
  }
  return bias;
}

}  // namespace

Status estimate_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                      const MotionRegimeSmoother::Params& params, std::vector<AngularRateState>& rates,
                      MotionRegimeSmoother::Report& report) {
  MotionRegimeSmoother::Params all = params;
  std::vector<std::vector<AuxiliaryReading>> readings;
  const Status status = align(auxiliary_imus, samples, params.rate.kGapMax_s, all.rate.model, readings);
  return status.ok() ? MotionRegimeSmoother(all).estimate(samples, readings, rates, report) : status;
}

RecoveredRates recover_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                             const MotionRegimeSmoother::Params& params, ReadingsToReplace replaced) {
  RecoveredRates out;
  out.samples.assign(samples.begin(), samples.end());
  out.covariances_rad2_s2.assign(samples.size(), Eigen::Matrix3d::Zero());
  out.sources.assign(samples.size(), AngularRateSource::measured);
  ClippingFinder::Params clipping;
  clipping.axis_limit_params = params.rate.saturation_detector;
  const ClippingFinder::ClippingSearchResult found = ClippingFinder(clipping).find(samples);
  out.saturation_levels = found.saturation_levels;
  std::vector<AngularRateState> rates;
  out.estimated = any_clips(clipped_readings_of(samples, found).clip_signs) &&
                  estimate_rates(samples, auxiliary_imus, params, rates, out.report).ok();
  if (!out.estimated) rates.clear();
  const Eigen::Vector3d bias = out.estimated ? bias_rad_s(samples, rates, replaced) : Eigen::Vector3d::Zero();
  const auto replace = [&](std::size_t k) {
    out.samples[k].angular_velocity_rad_s = rates[k].w_WI_I_rad_s + bias;
    out.covariances_rad2_s2[k] = rates[k].covariance_rad2_s2;
  };
  std::vector<std::uint8_t> hidden(samples.size(), 0);
  for (std::size_t k = 0; k < rates.size(); ++k) {
    out.sources[k] = rates[k].source;
    if (keeps_estimated_rate(rates[k], replaced)) continue;
    replace(k);
    hidden[k] = 1;
    ++out.replaced_reading_count;
  }
  if (replaced == ReadingsToReplace::clipped) return out;
  const std::vector<std::optional<InterpolatedRate>> interpolated = rates_between_readings(samples, hidden);
  for (std::size_t k = 0; k < interpolated.size(); ++k) {
    if (interpolated[k]) {
      out.samples[k].angular_velocity_rad_s = interpolated[k]->rate_rad_s;
      out.covariances_rad2_s2[k].setZero();
    } else if (out.estimated) {
      replace(k);
    }
  }
  return out;
}

}  // namespace tumble
