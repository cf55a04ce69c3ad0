// SPDX-License-Identifier: BSD-3-Clause
#include "rate_readings.hpp"

#include <algorithm>

#include "element_clipping.hpp"
#include "possible_saturation.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"

namespace tumble {

namespace {

void report_rails(const ClippingFinder& finder, const SaturationLevels& rails, RateReport& health) {
  const RailPlanes planes = rails.planes_in_use(), accel_planes = rails.planes_in_use(Triad::accelerometer);
  health.planes = rails.planes;
  health.accel_planes = accel_planes;
  health.clips_after_compensation = rails.gyro_clips_after_compensation;
  for (int c = 0; c < 6; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    health.rail[channel] = finder.axis_aligned_rails().rail(rails.axis_aligned_rails, c);
    const auto& plane = (c < 3 ? planes : accel_planes).element[static_cast<std::size_t>(c % 3)];
    if (plane) health.rail[channel] = plane->distance_rad_s;
    health.rail_observed[channel] = plane || rails.axis_aligned_rails.channels[channel].rail > 0.0;
    health.contradicts_stated_range[channel] = finder.axis_aligned_rails().disagrees(rails.axis_aligned_rails, c);
  }
}

void mark_possibly_clipped(const RailPlaneFinder::Params& expected, const ClippingFinder& finder,
                           const SaturationLevels& rails, const RailPlanes& planes, double noise_rad_s,
                           std::span<const ImuSample> samples, std::span<RateObservation> observations) {
  const std::vector<Neighbours> beside = other_readings(samples, Triad::gyro);
  MinSaturationLevels least;
  for (const RateObservation& o : observations) {
    if (o.clipping.unusable_gyro == 0) least.add(o.sample.angular_velocity_rad_s);
  }
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const auto [before, after] = beside[k];
    mark_subsample_saturation(planes, finder.axis_aligned_rails(), rails.axis_aligned_rails, noise_rad_s, before,
                              observations[k], after);
    if (rails.gyro_clips_after_compensation) continue;
    inflate_possible_saturation(planes, least, noise_rad_s, before, observations[k], after);
  }
  if (!rails.gyro_clips_after_compensation)
    inflate_motion_plateaus(planes, least, expected.kOffsetSigmaRatio, noise_rad_s, observations);
}

void mark_repeated(const std::optional<RepeatedReadings>& gyro, const std::optional<RepeatedReadings>& accel,
                   std::span<RateObservation> observations, RateReport& health) {
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (gyro) {
      observations[k].gyro_age_s = gyro->age_s[k];
      observations[k].gyro_repeats = gyro->repeats[k] && !observations[k].at_rest;
    }
    if (accel) observations[k].accel_age_s = accel->age_s[k];
  }
  if (gyro) health.gyro_update_s = gyro->period_s;
  if (accel) health.accel_update_s = accel->period_s;
}

}  // namespace

RateReadings read_samples(const RateSmoother::Params& params, const ClippingFinder& rails,
                          const ClippingFinder::Found& found, const std::vector<bool>& rest,
                          std::span<const ImuSample> samples,
                          std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, RateReport& health) {
  health.samples = samples.size();
  report_rails(rails, found.rails, health);

  RateReadings out{std::vector<RateObservation>(samples.size()), params.model, found.rails.planes_in_use(), {}};
  const double period_s = median_period_s(samples);
  out.known.calibration =
      prior_with_planes(RateModel(params.model, period_s), out.planes, found.rails.gyro_clips_after_compensation);
  const SensingDirections accel_rows = found.rails.rows(Triad::accelerometer, params.model.element_sigma);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    RateObservation& o = out.observations[k];
    o = {samples[k], found.clippings[k], rest[k]};
    o.accel_rows = accel_rows;
    for (std::size_t i = 0; i < auxiliary_imus.size(); ++i) o.auxiliary_imus[i] = auxiliary_imus[i][k];
  }
  mark_possibly_clipped(params.expert.planes, rails, found.rails, out.planes,
                        RateModel(out.known, period_s).gyro_sigma_rad_s(), samples, out.observations);
  out.gyro_repeated = find_repeated(samples, Triad::gyro);
  mark_repeated(out.gyro_repeated, find_repeated(samples, Triad::accelerometer), out.observations, health);
  return out;
}

}  // namespace tumble
