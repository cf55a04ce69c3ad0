// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/regime_smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "../angular_velocity/possible_saturation.hpp"
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"

namespace tumble {

namespace {

/// Readings that are saturated for only a part of the averaging window count as usable.
bool unusable_axis_count(const AngularRateReport& report, const AngularRateState& rate, std::size_t k) {
  return rate.clipped_axes != 0 || report.suspected_saturation_axes[k] != 0;
}

/// See carried.md (C37). Interpolates the specific forces to the times of the rates, because the readings of a slow
/// accelerometer are older than the gyro's rates.
std::vector<ImuSample> interpolate_forces(std::span<const ImuSample> samples) {
  std::vector<ImuSample> out(samples.begin(), samples.end());
  const std::vector<Eigen::Vector3d> forces = interpolated_forces(samples);
  for (std::size_t k = 0; k < forces.size(); ++k) out[k].specific_force_m_s2 = forces[k];
  return out;
}

/// Returns the saturated accelerometer axes as bits 3 (x) to 5 (z), the format that SpinTracker expects.
std::uint8_t saturated_forces(const ImuSample& sample, const AngularRateReport& report) {
  constexpr double kMargin = 0.95;  // tolerance, because the saturation limits differ between the axes
  unsigned out = 0;
  for (int j = 0; j < 3; ++j) {
    const std::optional<double>& rail = report.saturation_limits[static_cast<std::size_t>(3 + j)];
    if (rail && std::abs(sample.specific_force_m_s2[j]) > kMargin * *rail) out |= 8u << j;
  }
  return static_cast<std::uint8_t>(out);
}

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

void ClippedReadings::mark_suspected_saturation(std::span<const ImuSample> samples,
                                                std::span<const std::uint8_t> axes) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      std::int8_t& sign = clip_signs[k].gyro[static_cast<std::size_t>(j)];
      if ((axes[k] >> j & 1u) != 0 && sign == 0) sign = samples[k].angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
    }
  }
}

void ClippedReadings::mark_partly_saturated(std::span<AngularRateState> rates) const {
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (possibly_clipped_axes[k] != 0 && rates[k].source == AngularRateSource::measured)
      rates[k].source = AngularRateSource::lower_bound_only;
  }
}

ClippedReadings clipped_readings_of(std::span<const ImuSample> samples,
                                    const ClippingFinder::ClippingSearchResult& found) {
  ClippedReadings out;
  out.clip_signs.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k)
    out.clip_signs[k] = clip_signs(samples[k], found.clipping_per_sample[k]);
  out.possibly_clipped_axes =
      possible_partial_saturation(samples, found.saturation_levels.gyro_clips_after_compensation
                                               ? SaturationPlanes{}
                                               : found.saturation_levels.saturation_planes_in_use());
  out.sensing_directions = sensing_directions(found.saturation_levels.gyro_planes, 0.0).sensing_directions;
  return out;
}

MotionRegimeSmoother::MotionRegimeSmoother(const Params& params)
    : params_(params),
      rate_(params.rate),
      regime_evidence_(params.evidence),
      hand_held_(params.hand_held),
      spin_(params.spin) {
  require_valid_fields(params);
}

Status MotionRegimeSmoother::estimate(std::span<const ImuSample> samples,
                                      std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                                      std::vector<AngularRateState>& rates, Report& report) const {
  rates.clear();
  report = {};
  const Status status = rate_.estimate(samples, auxiliary_imus, rates, report.rate);
  if (!status.ok()) return status;
  if (auxiliary_imus.empty()) join_hand_held_rates(samples, rates, report);
  join_spin_rates(samples, !auxiliary_imus.empty(), rates, report);
  return {};
}

void MotionRegimeSmoother::join_spin_rates(std::span<const ImuSample> samples, bool further_imus,
                                           std::vector<AngularRateState>& rates, Report& report) const {
  std::vector<std::uint8_t> saturated_axes(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k)
    saturated_axes[k] = static_cast<std::uint8_t>(rates[k].clipped_axes | report.rate.suspected_saturation_axes[k] |
                                                  saturated_forces(samples[k], report.rate));
  const std::vector<SpinRate> spins = spin_.smooth(samples, saturated_axes, further_imus);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    rates[k] = spin_.combine_with_spin_rate(rates[k], spins[k], further_imus);
    if (spins[k].saturated && spins[k].probability > 0.5) ++report.spin_samples;
  }
}

void MotionRegimeSmoother::join_hand_held_rates(std::span<const ImuSample> samples,
                                                std::vector<AngularRateState>& rates, Report& report) const {
  const BodyImuCalibration& rig = report.rate.calibration;
  const Eigen::Matrix3d lever_covariance = rig.covariance.topLeftCorner<3, 3>();
  std::vector<RegimeProbabilities> probabilities;
  if (!regime_evidence_
           .find(interpolate_forces(samples), rates, rig.constants.lever_arm_m, lever_covariance, probabilities)
           .ok())
    return;
  report.regimes_estimated = true;
  const double each = 1.0 / static_cast<double>(probabilities.size());
  for (const RegimeProbabilities& share : probabilities) {
    report.probabilities.flight += each * share.flight;
    report.probabilities.contact += each * share.contact;
    report.probabilities.hand_held += each * share.hand_held;
  }
  const std::vector<double> by_segment = segment_hand_held_probability(probabilities, report.rate, rates);
  report.hand_held_probability_max = *std::max_element(by_segment.begin(), by_segment.end());
  if (report.hand_held_probability_max < params_.hand_held_probability_min) return;

  ClippingFinder::Params finding;
  finding.axis_limit_params = params_.rate.saturation_detector;
  ClippedReadings known = clipped_readings_of(samples, ClippingFinder(finding).find(samples));
  known.mark_suspected_saturation(samples, report.rate.suspected_saturation_axes);
  std::vector<AngularRateState> other = rates;
  if (!estimate_hand_held(samples, known, other, report.hand_held)) return;
  known.mark_partly_saturated(other);
  report.hand_held_smoother_ran = true;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (by_segment[k] <= params_.hand_held_probability_min) continue;
    const bool only_suspect = rates[k].clipped_axes == 0 && rates[k].source != AngularRateSource::measured;
    rates[k] = mix_rate_states(rates[k], other[k], by_segment[k]);
    if (only_suspect) rates[k].clipped_axes = 0, rates[k].source = AngularRateSource::lower_bound_only;
  }
}

/// Replaces the rates by the rates of HandHeldSmoother. Data gaps divide the recording into parts, and HandHeldSmoother
/// estimates each part separately. `report` describes the last part of the recording with a successful estimate.
bool MotionRegimeSmoother::estimate_hand_held(std::span<const ImuSample> samples, const ClippedReadings& known,
                                              std::vector<AngularRateState>& rates,
                                              HandHeldSmoother::Report& report) const {
  bool any = false;
  std::vector<AngularRateState> part;
  std::vector<AttitudeState> attitudes;
  for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
    const auto follows = [&](std::size_t k) {
      return check_stamp_order(samples[k].time_ns, samples[k - 1].time_ns, params_.hand_held.expert.gap_max_s).ok();
    };
    for (end = first + 1; end < samples.size() && follows(end);) ++end;
    SensingAxisClipSigns clipped = known.clipped_element_signs();
    clipped.clip_signs = clipped.clip_signs.subspan(first, end - first);
    HandHeldSmoother::Report of_part;
    if (!hand_held_.estimate(samples.subspan(first, end - first), clipped, part, attitudes, of_part).ok()) continue;
    std::copy(part.begin(), part.end(), rates.begin() + static_cast<std::ptrdiff_t>(first));
    report = of_part;
    any = true;
  }
  return any;
}

/// Returns the probability of hand-held motion near clipped or possibly saturated readings, and 0 for all other
/// readings: carried.md (C39).
std::vector<double> MotionRegimeSmoother::segment_hand_held_probability(
    std::span<const RegimeProbabilities> probabilities, const AngularRateReport& report,
    std::span<const AngularRateState> rates) const {
  std::vector<double> out(rates.size(), 0.0);
  const TimeNs near_ns = static_cast<TimeNs>(1e9 * params_.kSegmentGapMax_s);
  for (std::size_t k = 0; k < rates.size();) {
    if (!unusable_axis_count(report, rates[k], k)) {
      ++k;
      continue;
    }
    std::size_t first = k, last = k;
    for (; k < rates.size() && rates[k].time_ns <= rates[last].time_ns + near_ns; ++k)
      if (unusable_axis_count(report, rates[k], k)) last = k;
    const TimeNs from_ns = rates[first].time_ns - near_ns, to_ns = rates[last].time_ns + near_ns;
    std::size_t i = first, a = first, b = first;  // a to b: samples of the segment within kSegmentGapMax_s of sample i
    while (i > 0 && rates[i - 1].time_ns >= from_ns) --i;
    for (; i < rates.size() && rates[i].time_ns <= to_ns; ++i) {
      while (a < last && rates[a].time_ns < rates[i].time_ns - near_ns) ++a;
      while (b < last && rates[b + 1].time_ns <= rates[i].time_ns + near_ns) ++b;
      double least = 1.0;
      for (std::size_t j = a; j <= std::max(a, b); ++j) least = std::min(least, probabilities[j].hand_held);
      out[i] = std::max(out[i], least);
    }
  }
  return out;
}

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
