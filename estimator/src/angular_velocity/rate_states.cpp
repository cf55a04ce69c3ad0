// SPDX-License-Identifier: BSD-3-Clause
#include "rate_states.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "near_saturation_limits.hpp"
#include "tumble/angular_velocity/detail/interpolated_rates.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

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

}  // namespace

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

}  // namespace tumble
