// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "possible_saturation.hpp"
#include "rate_descent.hpp"
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

using Eigen::Vector3d;

namespace {

/// `known_params` contains the prior calibration. The detected saturation planes (SaturationPlane) determine the priors
/// of the cross-axis sensitivities.
struct AngularRateReadings {
  std::vector<AngularRateObservation> observations;
  AngularRateModelParams known_params;
  SaturationPlanes gyro_planes;
  std::optional<RepeatedReadings> gyro_repeated;
};

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

constexpr double kCommonDelaySigmas = 2.0;

std::vector<std::optional<InterpolatedRate>> interpolate_gyro(std::span<const ImuSample> samples,
                                                              const AngularRateReadings& readings) {
  std::vector<std::uint8_t> hidden(samples.size());
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    const AngularRateObservation& o = readings.observations[k];
    hidden[k] = static_cast<std::uint8_t>(o.clipping.gyro | o.clipping.unusable_gyro | o.partly_saturated_axes());
  }
  return rates_between_readings(samples, hidden, readings.gyro_repeated);
}

// See rate_smoother.md (R44).
Eigen::Matrix3d sensor_error_covariance(const arrow::ErrorMatrix& moved, const SensorErrors::Matrix& covariance,
                                        double rate_max_rad_s) {
  const Eigen::Matrix<double, 3, SensorErrors::kSize> rates = moved.topRows<3>(), spread = rates * covariance;
  const Eigen::Matrix3d out = spread.lazyProduct(rates.transpose());
  const double most = rate_max_rad_s * rate_max_rad_s;
  return std::min(1.0, most / std::max(out.trace(), 1e-300)) * out;
}

// Returns the magnitude of the angular acceleration between samples `k` and `k + 1`. If a gyro reading may be
// saturated, the angular acceleration is estimated from the contact force.
double rate_change_rad_s2(const AngularRateModelParams& params, std::span<const AngularRateObservation> observations,
                          std::span<const AngularRateEstimate> estimates, std::size_t k) {
  const AngularRateObservation &from = observations[k], &to = observations[k + 1];
  if (from.at_rest && to.at_rest) return 0.0;
  if (((from.clipping.gyro | from.possibly_saturated_axes()) | (to.clipping.gyro | to.possibly_saturated_axes())) != 0)
    return params.expert.contact.kGain_rad_m *
           std::max(estimates[k].contact_force_m_s2.norm(), estimates[k + 1].contact_force_m_s2.norm());
  const double dt_s = seconds(to.sample.time_ns - from.sample.time_ns);
  return (estimates[k + 1].knot.rate_rad_s - estimates[k].knot.rate_rad_s).norm() / dt_s;
}

// Returns the covariance of a rate due to an unknown delay that gyro and accelerometer have in common. The covariance
// is computed with the largest angular acceleration within the possible delay, because an impact may have occurred
// before or after sample `k`.
Eigen::Matrix3d common_delay_covariance(double variance_s2, const AngularRateModelParams& params,
                                        std::span<const AngularRateObservation> observations,
                                        std::span<const AngularRateEstimate> estimates, std::size_t k) {
  if (!(variance_s2 > 0.0)) return Eigen::Matrix3d::Zero();
  const auto delay_range_ns = static_cast<TimeNs>(1e9 * kCommonDelaySigmas * std::sqrt(variance_s2));
  const TimeNs now = observations[k].sample.time_ns;
  double change = 0.0;
  for (std::size_t i = k; i > 0 && now - observations[i].sample.time_ns <= delay_range_ns; --i)
    change = std::max(change, rate_change_rad_s2(params, observations, estimates, i - 1));
  for (std::size_t i = k; i + 1 < estimates.size() && observations[i].sample.time_ns - now < delay_range_ns; ++i)
    change = std::max(change, rate_change_rad_s2(params, observations, estimates, i));
  const Vector3d& alpha = estimates[k].knot.acceleration_rad_s2;
  return variance_s2 * (alpha * alpha.transpose() + change * change * Eigen::Matrix3d::Identity());
}

AngularRateState extrapolated_state(std::span<const AngularRateObservation> observations,
                                    std::span<const AngularRateEstimate> estimates,
                                    std::span<const Eigen::Matrix3d> covariances, std::size_t k, double late_s) {
  AngularRateState out;
  double left_s = late_s;
  for (; k + 1 < estimates.size(); ++k) {
    const double dt_s = seconds(observations[k + 1].sample.time_ns - observations[k].sample.time_ns);
    if (left_s < dt_s) {
      const AngularRateKnot &a = estimates[k].knot, &b = estimates[k + 1].knot;
      const double u = std::max(0.0, left_s / dt_s), v = 1.0 - u;
      out.w_WI_I_rad_s = v * v * (1.0 + 2.0 * u) * a.rate_rad_s + u * u * (3.0 - 2.0 * u) * b.rate_rad_s +
                         u * v * dt_s * (v * a.acceleration_rad_s2 - u * b.acceleration_rad_s2);
      out.covariance_rad2_s2 = v * covariances[k] + u * covariances[k + 1];
      return out;
    }
    left_s -= dt_s;
  }
  out.w_WI_I_rad_s = estimates[k].knot.rate_rad_s;
  out.covariance_rad2_s2 = covariances[k];
  return out;
}

std::vector<Eigen::Matrix3d> rate_covariances(const AngularRateSmoother::Params& params,
                                              const AngularRateReadings& readings, const AngularRateFit& fit,
                                              const AngularRateReport& health) {
  const std::vector<AngularRateEstimate>& estimates = fit.solution.estimates;
  const double shared_s2 = health.common_delay_sigma_s * health.common_delay_sigma_s;
  std::vector<Eigen::Matrix3d> out(estimates.size());
  fit.solution.iteration.for_each_state_given_next([&](std::size_t k, const arrow::Conditional& conditional) {
    const Eigen::Matrix3d covariance =
        arrow::rate_covariance(conditional, fit.solution.rig_covariance) +
        sensor_error_covariance(fit.error_derivatives.sample_error_jacobian[k], health.sensor_errors.covariance,
                                params.model.kRateMax_rad_s) +
        common_delay_covariance(shared_s2, readings.known_params, readings.observations, estimates, k);
    out[k] = fit.model.output_covariance(covariance, readings.observations[k], estimates[k]);
  });
  return out;
}

void count(const AngularRateState& state, const AngularRateObservation& observation, AngularRateReport& report) {
  report.clipped_sample_count += state.clipped_axes != 0;
  report.recovered_in_flight += state.source == AngularRateSource::recovered_in_flight;
  report.recovered_in_contact += state.source == AngularRateSource::recovered_in_contact;
  report.lower_bound_only += state.source == AngularRateSource::lower_bound_only;
  report.missing_readings += observation.clipping.unusable_gyro != 0;
  report.suspected_saturation_axes.push_back(
      static_cast<std::uint8_t>(observation.possibly_saturated_axes() & ~state.clipped_axes));
}

Status check_auxiliary_imus(const AngularRateModelParams& params,
                            std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, std::size_t count) {
  const auto needed = static_cast<double>(params.auxiliary_imus.size());
  if (auxiliary_imus.size() != params.auxiliary_imus.size()) {
    return {ErrorCode::insufficient_data, "auxiliary_imus", static_cast<double>(auxiliary_imus.size()), needed};
  }
  for (const std::vector<AuxiliaryReading>& readings : auxiliary_imus) {
    if (readings.size() == count) continue;
    return {ErrorCode::insufficient_data, "readings of an auxiliary_imu", static_cast<double>(readings.size()),
            static_cast<double>(count)};
  }
  return {};
}

/// A large zero offset of the gyro becomes the nominal bias, unless the user states a bias.
AngularRateSmootherParams with_gyro_offset(const AngularRateSmootherParams& params,
                                           std::span<const ImuSample> samples) {
  AngularRateSmootherParams out = params;
  Eigen::Vector3d& nominal = out.model.nominal.gyro_bias_rad_s;
  if (nominal.isZero(0.0) && !out.model.calibration) nominal = GyroOffset().find(samples);
  return out;
}

/// Converts IMU samples (at least two) to observations, and marks clipped and repeated readings. Cost: O(number of
/// samples).
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

/// Computes angular rates and covariances at the times of the gyro's readings. The covariances include the uncertainty
/// of sensor errors, calibration, and the common delay of gyro and accelerometer (rate_smoother.md). If the log repeats
/// gyro readings, interpolated readings replace less accurate estimates.
std::vector<AngularRateState> rate_states_of_recording(const AngularRateSmoother::Params& params,
                                                       std::span<const ImuSample> samples,
                                                       const AngularRateReadings& readings, const AngularRateFit& fit,
                                                       AngularRateReport& health) {
  const std::vector<AngularRateObservation>& observations = readings.observations;
  const RateSolution& solution = fit.solution;
  const SensorErrors& errors = health.sensor_errors.errors;
  const double gyro_late_s = std::max(0.0, -errors.accel_delay_s);
  const std::vector<Eigen::Matrix3d> covariances = rate_covariances(params, readings, fit, health);
  // If the device clips after misalignment compensation, saturated readings are equal, so saturation planes are not
  // needed to find partial saturation.
  const std::vector<std::uint8_t> near =
      possible_partial_saturation(samples, health.clips_after_compensation ? SaturationPlanes{} : readings.gyro_planes);
  const std::vector<std::optional<InterpolatedRate>> own = interpolate_gyro(samples, readings);
  std::vector<AngularRateState> states(samples.size());
  std::size_t in_flight = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const AngularRateObservation& o = observations[k];
    const AngularRateEstimate& estimate = solution.estimates[k];
    AngularRateState& state = states[k];
    state = extrapolated_state(observations, solution.estimates, covariances, k, gyro_late_s);
    // Outside free flight, rates interpolated between gyro readings are more accurate than the rates of the white-jerk
    // model.
    const bool by_readings = estimate.flight_weight < 0.5 && !o.at_rest && gyro_late_s == 0.0;
    if (by_readings && !own.empty() && own[k]) {
      const Vector3d g_sensitivity = errors.g_sensitivity_s_m * samples[k].specific_force_m_s2;
      state.w_WI_I_rad_s = own[k]->rate_rad_s - g_sensitivity - solution.rig.gyro_bias_rad_s;
      state.covariance_rad2_s2.diagonal() += own[k]->variance_rad2_s2;
    }
    state.time_ns = samples[k].time_ns;
    state.clipped_axes = o.clipping.gyro | o.clipping.unusable_gyro;
    state.source = rate_source_of(o, estimate, state.covariance_rad2_s2);
    if (near[k] != 0 && state.source == AngularRateSource::measured) state.source = AngularRateSource::lower_bound_only;
    count(state, o, health);
    in_flight += estimate.flight_weight >= 0.5;
  }
  health.flight_fraction = static_cast<double>(in_flight) / static_cast<double>(samples.size());
  return states;
}

}  // namespace

AngularRateSmoother::AngularRateSmoother(const Params& params)
    : params_(params),
      clipping_finder_({params.saturation_detector, params.expert.gyro_planes, params.expert.accel_saturation_planes}),
      rest_detector_(params.expert.rest_detector) {
  require_valid_fields(params);
  if (params.calibrated_errors) require_valid_known_errors(*params.calibrated_errors);
  (void)AngularRateModel(params.model, 0.01);  // throws for invalid parameters
}

Status AngularRateSmoother::estimate(std::span<const ImuSample> samples,
                                     std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                                     std::vector<AngularRateState>& out, AngularRateReport& report) const {
  if (Status status = check_recording(samples, 2, std::numeric_limits<double>::infinity()); !status.ok()) return status;
  if (Status status = check_auxiliary_imus(params_.model, auxiliary_imus, samples.size()); !status.ok()) return status;

  AngularRateReport health;
  const ClippingFinder::ClippingSearchResult found = clipping_finder_.find(samples);
  const Params params = with_gyro_offset(params_, samples);
  const std::vector<bool> rests = rest_detector_.find(samples, params.model.nominal.gyro_bias_rad_s);
  AngularRateReadings readings = read_samples(params, clipping_finder_, found, rests, samples, auxiliary_imus, health);
  AngularRateFit fit(readings.observations, AngularRateModel(readings.known_params, median_period_s(samples)));
  if (Status status = fit_rounds(params, readings.known_params, samples, found.clipping_per_sample,
                                 readings.observations, fit, health);
      !status.ok()) {
    return status;
  }
  out = rate_states_of_recording(params, samples, readings, fit, health);
  report = std::move(health);
  return {};
}

}  // namespace tumble
