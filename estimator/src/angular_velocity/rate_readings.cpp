// SPDX-License-Identifier: BSD-3-Clause
#include "rate_readings.hpp"

#include <algorithm>

#include "element_clipping.hpp"
#include "possible_saturation.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"

namespace tumble {

namespace {

void report_rails(const ClippingFinder& finder, const SaturationLevels& rails, AngularRateReport& health) {
  const SaturationPlanes planes = rails.saturation_planes_in_use(),
                         accel_planes = rails.saturation_planes_in_use(Triad::accelerometer);
  health.gyro_planes = rails.gyro_planes;
  health.accel_saturation_planes = accel_planes;
  health.clips_after_compensation = rails.gyro_clips_after_compensation;
  for (int c = 0; c < 6; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    health.saturation_limits[channel] = finder.axis_limit_detector().saturation_limit(rails.axis_limit_state, c);
    const auto& plane = (c < 3 ? planes : accel_planes).sensing_axis[static_cast<std::size_t>(c % 3)];
    if (plane) health.saturation_limits[channel] = plane->saturation_limit_rad_s;
    health.saturation_limit_observed[channel] = plane || rails.axis_limit_state.channels[channel].plateau_limit > 0.0;
    health.contradicts_stated_range[channel] = finder.axis_limit_detector().disagrees(rails.axis_limit_state, c);
  }
}

void mark_possibly_clipped(const SaturationPlaneFinder::Params& expected, const ClippingFinder& finder,
                           const SaturationLevels& rails, const SaturationPlanes& planes, double noise_rad_s,
                           std::span<const ImuSample> samples, std::span<AngularRateObservation> observations) {
  const std::vector<Neighbours> beside = neighbouring_readings(samples, Triad::gyro);
  MinSaturationLevels least;
  for (const AngularRateObservation& o : observations) {
    if (o.clipping.unusable_gyro == 0) least.add(o.sample.angular_velocity_rad_s);
  }
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const auto [before, after] = beside[k];
    mark_partial_saturation(planes, finder.axis_limit_detector(), rails.axis_limit_state, noise_rad_s, before,
                            observations[k], after);
    if (rails.gyro_clips_after_compensation) continue;
    inflate_covariance_near_limits(planes, least, noise_rad_s, before, observations[k], after);
  }
  if (!rails.gyro_clips_after_compensation)
    inflate_covariance_at_plateaus(planes, least, expected.kOffsetSigmaRatio, noise_rad_s, observations);
}

void mark_repeated(const std::optional<RepeatedReadings>& gyro, const std::optional<RepeatedReadings>& accel,
                   std::span<AngularRateObservation> observations, AngularRateReport& health) {
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (gyro) {
      observations[k].gyro_age_s = gyro->age_s[k];
      observations[k].gyro_repeats = gyro->repeats_per_sample[k] && !observations[k].at_rest;
    }
    if (accel) observations[k].accel_age_s = accel->age_s[k];
  }
  if (gyro) health.gyro_update_interval_s = gyro->period_s;
  if (accel) health.accel_update_interval_s = accel->period_s;
}

}  // namespace

AngularRateReadings read_samples(const AngularRateSmoother::Params& params, const ClippingFinder& rails,
                                 const ClippingFinder::ClippingSearchResult& found, const std::vector<bool>& rest,
                                 std::span<const ImuSample> samples,
                                 std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                                 AngularRateReport& health) {
  health.samples = samples.size();
  report_rails(rails, found.saturation_levels, health);

  AngularRateReadings out{std::vector<AngularRateObservation>(samples.size()),
                          params.model,
                          found.saturation_levels.saturation_planes_in_use(),
                          {}};
  const double period_s = median_period_s(samples);
  out.known_params.calibration = calibration_prior_from_planes(
      AngularRateModel(params.model, period_s), out.gyro_planes, found.saturation_levels.gyro_clips_after_compensation);
  const SensingDirections accel_rows = found.saturation_levels.rows(Triad::accelerometer, params.model.element_sigma);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    AngularRateObservation& o = out.observations[k];
    o = {samples[k], found.clipping_per_sample[k], rest[k]};
    o.accel_sensing_directions = accel_rows;
    for (std::size_t i = 0; i < auxiliary_imus.size(); ++i) o.auxiliary_imus[i] = auxiliary_imus[i][k];
  }
  mark_possibly_clipped(params.expert.gyro_planes, rails, found.saturation_levels, out.gyro_planes,
                        AngularRateModel(out.known_params, period_s).gyro_sigma_rad_s(), samples, out.observations);
  out.gyro_repeated = find_repeated(samples, Triad::gyro);
  mark_repeated(out.gyro_repeated, find_repeated(samples, Triad::accelerometer), out.observations, health);
  return out;
}

}  // namespace tumble
