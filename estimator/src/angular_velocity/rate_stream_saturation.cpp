// SPDX-License-Identifier: BSD-3-Clause
// AngularRateStream treats the sensor errors as consider parameters (Schmidt, 1966).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "possible_saturation.hpp"
#include "rate_stream_impl.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// The slopes before and after a maximum predict how far the rate rises above the readings at the maximum:
// rate_stream.md (R94). If the rate is an unsaturated parabola, the predicted rise is at most 2.25 times the difference
// between the largest and the smallest reading.
constexpr double kSlopeSigmasMax = 3.0, kHeightRatioMin = 4.0, kHeightNoiseSigmas = 5.0;
constexpr std::ptrdiff_t kPlateauReadingsMin = 3;

// maximum relative difference between the saturation levels of two elements; 3 % for the wand in the data set RepoIMU
constexpr double kLevelDifferenceMax = 0.05;

bool is_near_limit_of_other_axis(const SaturationPlanes& planes, double peak_rad_s) {
  return std::all_of(planes.sensing_axis.begin(), planes.sensing_axis.end(), [&](const auto& element) {
    return !element || peak_rad_s >= (1.0 - kLevelDifferenceMax) * element->saturation_limit_rad_s;
  });
}

std::optional<std::size_t> reading_before(std::size_t k, const std::vector<AngularRateStream::Knot>& window) {
  while (k > 0 && window[k].repeats_reading) --k;
  if (k == 0) return std::nullopt;
  --k;
  while (k > 0 && window[k].repeats_reading) --k;
  return k;
}

std::size_t reading_after(std::size_t k, const std::vector<AngularRateStream::Knot>& window) {
  const std::size_t size = window.size();
  if (k >= size) return size;
  ++k;
  while (k < size && window[k].repeats_reading) ++k;
  return k;
}

struct NeighbouringSamples {
  const ImuSample *previous_sample = nullptr, *next_sample = nullptr;
};

NeighbouringSamples neighbour_readings(std::size_t k, const AngularRateStream::State& state) {
  const std::optional<std::size_t> before = reading_before(k, state.window);
  const std::size_t after = reading_after(k, state.window);
  NeighbouringSamples out;
  if (before) out.previous_sample = &state.window[*before].observation.sample;
  if (after < state.window.size()) out.next_sample = &state.window[after].observation.sample;
  return out;
}

using Eigen::Matrix3d;

// The sensor errors are estimated only at intervals, because each estimate solves a system of 29 unknowns, which costs
// more than a step of the stream.
constexpr TimeNs kUpdatePeriod_ns = 50'000'000;

// See rate_smoother.md (R44).
Matrix3d rate_covariance_from_errors(const arrow::ErrorMatrix& moved, const SensorErrors::Matrix& covariance,
                                     double rate_max_rad_s) {
  const Eigen::Matrix<double, 3, SensorErrors::kSize> rates = moved.topRows<3>(),
                                                      spread = rates.lazyProduct(covariance);
  const Matrix3d out = spread.lazyProduct(rates.transpose());
  return std::min(1.0, rate_max_rad_s * rate_max_rad_s / std::max(out.trace(), 1e-300)) * out;
}

bool has_moved_states(const AngularRateStream::Knot& knot) {
  return !knot.observation.at_rest;
}

}  // namespace

void AngularRateStream::Impl::reclassify_window_clipping(State& state) const {
  SaturationLimitDetector::State& axis_aligned_rails = state.clipping_state.known_limits.axis_limit_state;
  for (SaturationLimitDetector::Channel& channel : axis_aligned_rails.channels) channel.is_clipped = false;
  for (Knot& knot : state.window) {
    ImuSample sample = knot.observation.sample;
    sample.specific_force_m_s2 = knot.received_force.force_m_s2;
    sample.device_clip_flags =
        static_cast<std::uint8_t>((sample.device_clip_flags & kClipGyro) | knot.received_force.device_clip_flags);
    knot.clipping_at_axis_limits = clipping_finder.axis_limit_detector().classify_clipping(sample, axis_aligned_rails);
    knot.received_force.clipped_axes = knot.clipping_at_axis_limits.accel;
  }
  for (std::size_t k = 0; force_delay_samples(state) != 0 && k < state.window.size(); ++k)
    pair_force_with_rate(k, state);
}

// A new gyro reading may show whether the previous reading is clipped.
void AngularRateStream::Impl::classify_clipping_from(std::size_t changed, State& state) const {
  const std::size_t first = reading_before(changed, state.window).value_or(0);
  const SaturationLevels& rails = state.clipping_state.known_limits;
  const SaturationPlanes planes = rails.saturation_planes_in_use(),
                         accel_planes = rails.saturation_planes_in_use(Triad::accelerometer);
  const SensingDirections accel_rows = rails.rows(Triad::accelerometer, params.model.element_sigma);
  const double noise = model.gyro_sigma_rad_s();
  for (std::size_t k = first; k < state.window.size(); ++k) {
    Knot& knot = state.window[k];
    AngularRateObservation& now = knot.observation;
    const NeighbouringSamples gyro = neighbour_readings(k, state);
    const ImuSample *const before = gyro.previous_sample, *const after = gyro.next_sample;
    const ImuSample* const sample_before = k > 0 ? &state.window[k - 1].observation.sample : nullptr;
    const ImuSample* const sample_after =
        k + 1 < state.window.size() ? &state.window[k + 1].observation.sample : nullptr;
    const std::uint8_t read = now.unmeasured_axes();
    Clipping by_axis_aligned_rails = knot.clipping_at_axis_limits;
    if (sample_after != nullptr) {
      clipping_finder.axis_limit_detector().add_rising_edge_at_limit(now.sample, *sample_after,
                                                                     state.window[k + 1].clipping_at_axis_limits,
                                                                     rails.axis_limit_state, by_axis_aligned_rails);
    }
    now.clipping = clipping_from_planes(planes, Triad::gyro, by_axis_aligned_rails, before, now.sample, after);
    now.clipping =
        clipping_from_planes(accel_planes, Triad::accelerometer, now.clipping, sample_before, now.sample, sample_after);
    now.accel_sensing_directions = accel_rows;
    mark_partial_saturation(planes, clipping_finder.axis_limit_detector(), rails.axis_limit_state, noise, before, now,
                            after);
    knot.possibly_clipped_axes = rails.gyro_clips_after_compensation
                                     ? std::uint8_t{0}
                                     : possible_partial_saturation(before, now.sample, after, planes);
    mark_undetected_clipping(k, state);
    const bool newest = k + 1 == state.window.size();
    if (!newest && (now.unmeasured_axes() & ~read) == 0) continue;
    if (!newest) {
      knot.knot_age_samples = 0;
      knot.estimate.use_soft_bounds = false;
    }
    if (k > 0) predict_new_knot(knot, state.window[k - 1], state);
  }
}

// See rate_stream.md (R93).
bool AngularRateStream::Impl::is_near_saturation_limit(const ImuSample& sample, int axis, int sign,
                                                       const State& state) const {
  const Vector3d& y = sample.angular_velocity_rad_s;
  const SaturationPlanes planes = state.clipping_state.known_limits.saturation_planes_in_use();
  const auto& plane = planes.sensing_axis[static_cast<std::size_t>(axis)];
  if (sign * y[axis] <= 0.0) return false;
  if (plane && plane->was_reached(sign)) {
    const Eigen::Vector4d by(y[(axis + 1) % 3], y[(axis + 2) % 3], -sign, -1.0);
    const double open = std::sqrt(std::max(0.0, by.dot(plane->covariance * by)));
    return plane->distance_to_plane_rad_s(y, sign) <= plane->tolerance_rad_s + kSlopeSigmasMax * open;
  }
  const double extreme = std::abs(state.reading_extremes_rad_s[sign > 0 ? 1 : 0][axis]);
  const bool high =
      extreme >= params.expert.gyro_planes.distance_min_rad_s && is_near_limit_of_other_axis(planes, extreme);
  return high && std::abs(y[axis]) >= (1.0 - kNearRailRatio) * extreme;
}

void AngularRateStream::Impl::mark_undetected_clipping(std::size_t k, State& state) const {
  AngularRateObservation& now = state.window[k].observation;
  now.rarely_high_axes = 0;
  if (state.clipping_state.known_limits.gyro_clips_after_compensation) return;
  const auto [before, after] = neighbour_readings(k, state);
  inflate_covariance_near_limits(state.clipping_state.known_limits.saturation_planes_in_use(),
                                 state.min_saturation_levels, model.gyro_sigma_rad_s(), before, now, after);
}

// A later, larger reading or a newly detected saturation level may show that readings marked as possibly saturated are
// unsaturated.
void AngularRateStream::Impl::clear_suspected_saturation(State& state) const {
  for (std::size_t k = 0; k < state.window.size(); ++k) {
    if (state.window[k].observation.possibly_saturated_axes() == 0) continue;
    state.window[k].observation.suspected_saturation = 0;
    mark_undetected_clipping(k, state);
  }
}

// Marks runs of three or more readings that may be saturated, but that the device has not flagged as clipped.
void AngularRateStream::Impl::mark_possible_saturation(State& state) const {
  const unsigned stood = state.window.front().observation.suspected_saturation;
  clear_suspected_saturation(state);
  for (int j = 0; j < 3; ++j) {
    if (clipping_finder.axis_limit_detector().saturation_limit(state.clipping_state.known_limits.axis_limit_state, j))
      continue;
    for (std::size_t k = 0; k < state.window.size();) {
      const int sign = state.window[k].observation.sample.angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
      std::size_t end = k;
      while (end < state.window.size() &&
             is_near_saturation_limit(state.window[end].observation.sample, j, sign, state))
        ++end;
      const bool goes_on = k == 0 && end > k && (stood >> j & 1u) != 0;
      const auto readings = std::count_if(state.window.begin() + static_cast<std::ptrdiff_t>(k),
                                          state.window.begin() + static_cast<std::ptrdiff_t>(end),
                                          [](const Knot& knot) { return !knot.repeats_reading; });
      if (goes_on || readings >= kPlateauReadingsMin) mark_suspected_plateau(j, k, end - 1, state);
      k = std::max(end, k + 1);
    }
  }
}

// Returns the slope of the readings per sample at the ends of a run of possibly saturated readings. Each slope is the
// smaller of two consecutive rate changes, because an impact causes a single large change.
double AngularRateStream::Impl::plateau_slope(int axis, std::size_t first, std::size_t last, const State& state) {
  const auto size = [&](std::size_t k) {
    return std::abs(state.window[k].observation.sample.angular_velocity_rad_s[axis]);
  };
  const double in =
      first > 0 ? state.window[first - 1].plateau_growth_rad_s[axis] : state.slope_before_clipping_rad_s[axis];
  const std::size_t one = reading_after(last, state.window), two = reading_after(one, state.window),
                    three = reading_after(two, state.window);
  const bool left = three < state.window.size();
  const auto falls = [&](std::size_t a, std::size_t b) { return (size(a) - size(b)) / static_cast<double>(b - a); };
  const double out = left ? std::min(falls(one, two), falls(two, three)) : 0.0;
  return std::max({in, out, 0.0});
}

// Estimates the saturation deficit from the slopes before and after a run of possibly saturated readings:
// rate_stream.md (R94).
void AngularRateStream::Impl::mark_suspected_plateau(int axis, std::size_t first, std::size_t last,
                                                     State& state) const {
  const auto size = [&](std::size_t k) {
    return std::abs(state.window[k].observation.sample.angular_velocity_rad_s[axis]);
  };
  const auto bit = static_cast<std::uint8_t>(1u << axis);
  double highest = 0.0, lowest = size(first);
  for (std::size_t k = first; k <= last; ++k) {
    highest = std::max(highest, size(k));
    lowest = std::min(lowest, size(k));
  }
  const double slope = plateau_slope(axis, first, last, state);
  const double samples =
      static_cast<double>(last - first + 1) + (first > 0 ? 0.0 : state.samples_since_clipping_start[axis]);
  const double cut = 0.25 * samples * slope;
  const double noise = model.gyro_sigma_rad_s();
  if (cut < kHeightRatioMin * (highest - lowest) || cut < kHeightNoiseSigmas * noise) return;
  for (std::size_t k = first; k <= last; ++k) {
    AngularRateObservation& observation = state.window[k].observation;
    if (((observation.clipping.gyro | observation.clipping.unusable_gyro) & bit) != 0) continue;
    observation.rarely_high_axes = static_cast<std::uint8_t>(observation.rarely_high_axes & ~bit);
    observation.suspected_saturation = static_cast<std::uint8_t>(observation.suspected_saturation | bit);
    // The errors of all saturated readings of a run are correlated, so the run counts as one reading.
    observation.saturation_deficit_sigma_rad_s[axis] = std::hypot(noise, std::sqrt(samples) * cut);
  }
}

// Returns the smaller of two consecutive increases of the gyro reading, because an impact causes one large increase.
Vector3d AngularRateStream::Impl::min_recent_increase_rad_s(const std::vector<Knot>& window) {
  const std::optional<std::size_t> one = reading_before(window.size() - 1, window);
  const std::optional<std::size_t> two = one ? reading_before(*one, window) : std::nullopt;
  if (!two) return Vector3d::Zero();
  const auto size = [&](std::size_t k) -> Vector3d {
    return window[k].observation.sample.angular_velocity_rad_s.cwiseAbs();
  };
  const std::size_t newest = reading_after(*one, window);
  const Vector3d now = (size(newest) - size(*one)) / static_cast<double>(newest - *one);
  const Vector3d before = (size(*one) - size(*two)) / static_cast<double>(*one - *two);
  return now.cwiseMin(before).cwiseMax(0.0);
}

// Stores the slope of the gyro readings before a saturation when the readings before the saturation leave the window of
// AngularRateStream.
void AngularRateStream::Impl::store_slope_before_clipping(const Knot& leaving, const Knot& next, State& state) {
  const auto hidden = [](const Knot& knot, int j) {
    return ((knot.observation.clipping.gyro | knot.observation.partly_saturated_axes()) >> j & 1) != 0;
  };
  for (int j = 0; j < 3; ++j) {
    const bool goes_on = hidden(leaving, j) && hidden(next, j);
    state.samples_since_clipping_start[j] = goes_on ? state.samples_since_clipping_start[j] + 1.0 : 0.0;
    if (!goes_on) state.slope_before_clipping_rad_s[j] = hidden(next, j) ? leaving.plateau_growth_rad_s[j] : 0.0;
  }
}

void AngularRateStream::Impl::add_misalignment_prior(const State& state, arrow::Corner& corner) const {
  const SaturationLevels& rails = state.clipping_state.known_limits;
  const SaturationPlanes planes = rails.saturation_planes_in_use();
  for (int j = 0; j < 3; ++j) {
    const Eigen::Index first = BodyImuConstants::kGyroMisalignmentIndex + 2 * j;
    const auto prior_slopes = estimated_slopes(planes, rails.gyro_clips_after_compensation, j,
                                               model.prior_covariance().block<2, 2>(first, first));
    if (!prior_slopes) continue;
    const Eigen::Matrix2d information = prior_slopes->covariance.inverse();
    corner.matrix.block<2, 2>(first, first) += information;
    corner.gradient.segment<2>(first) -=
        information * (state.rig.gyro_misalignment.segment<2>(2 * j) - prior_slopes->cross_axis_slopes);
  }
}

// See rate_stream.md (R100).
void AngularRateStream::Impl::marginalise_sensor_errors(const arrow::Block& block, arrow::ErrorMatrix& errors,
                                                        State& state) const {
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  device.prior.setZero();
  arrow::eliminate_sensor_errors(block, errors, &device.prior, device.border_errors);
  device.sensor_error_evidence.information.noalias() -= errors.transpose().lazyProduct(errors);
  device.sensor_error_evidence.gradient.noalias() += errors.transpose().lazyProduct(block.gradient);
}

void AngularRateStream::Impl::discard_marginalised_information(State& state) const {
  state.prior = {};
  state.prior_border_block = {};
  model.add_rig_prior(state.rig, state.prior_border_block);
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  device.prior.setZero();
  device.border_errors.setZero();
  device.sensor_error_evidence.information.setZero();
  device.sensor_error_evidence.gradient.setZero();
}

void AngularRateStream::Impl::reset_rig(State& state) const {
  state.rig = state.prior_rig = model.prior_constants();
  state.rig_covariance = model.prior_covariance();
  discard_marginalised_information(state);
  state.calibration_samples = 0;
}

KnownSensorErrors AngularRateStream::sensor_errors_except_biases(const State& state) const {
  const AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  KnownSensorErrors out{
      impl_->params.calibrated_errors ? impl_->params.calibrated_errors->errors : impl_->params.model.errors,
      device.posterior.covariance};
  out.errors.accel_delay_s = device.accel_delay_state.applied_delay_s;
  return out;
}

// See rate_stream.md (R101). The caller must factorise the normal equations at the current estimates and calibration.
void AngularRateStream::Impl::add_sensor_error_covariance(const arrow::BorderVector& rig_step, State& state) const {
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  const std::size_t count = state.window.size();
  if (std::none_of(state.window.begin(), state.window.end(), has_moved_states)) {
    std::fill_n(device.sample_jacobian.begin(), count, arrow::ErrorMatrix::Zero());
    return;
  }
  std::vector<arrow::ErrorMatrix>& errors = device.sample_jacobian;
  auto& [border, calibration_by_errors, window_error_evidence, posterior_workspace] = device.work_matrices;
  border = device.border_errors;
  window_error_evidence = device.sensor_error_evidence;
  errors[0] = device.prior;
  std::fill_n(errors.begin() + 1, count - 1, arrow::ErrorMatrix::Zero());
  for (std::size_t k = 0; k < count; ++k) {
    const Knot& knot = state.window[k];
    model.add_sensor_errors(knot.observation, knot.estimate, state.rig, errors[k], border, window_error_evidence);
    arrow::eliminate_sensor_errors(state.work_blocks[k], errors[k], k + 1 == count ? nullptr : &errors[k + 1], border);
    window_error_evidence.information.noalias() -= errors[k].transpose().lazyProduct(errors[k]);
    window_error_evidence.gradient.noalias() += errors[k].transpose().lazyProduct(state.work_blocks[k].gradient);
  }
  calibration_by_errors.noalias() = state.rig_covariance.lazyProduct(border);
  for (std::size_t k = count; k-- > 0;)
    errors[k] = arrow::back_substitute_errors(state.work_blocks[k], errors[k],
                                              k + 1 == count ? nullptr : &errors[k + 1], calibration_by_errors);

  const TimeNs now_ns = state.window.back().observation.sample.time_ns;
  if (params.calibrated_errors || (device.updated_ns && now_ns - *device.updated_ns < kUpdatePeriod_ns)) return;
  device.updated_ns = now_ns;
  window_error_evidence.information.noalias() -= border.transpose().lazyProduct(calibration_by_errors);
  window_error_evidence.gradient.noalias() += border.transpose().lazyProduct(rig_step);
  discount_unobservable(model.independent_sample_fraction(), window_error_evidence);
  AngularRateStreamDelay& delay = device.accel_delay_state;
  if (delay.delay_found) {
    if (const TriadDelay& guess = delay.impact_delay; guess.sigma_s > 0.0) {
      // The information is divided by kSensorErrorEvidenceWeight, because SensorErrorUncertainty multiplies all
      // information by kSensorErrorEvidenceWeight.
      const double information =
          1.0 / (SensorErrorUncertainty::kSensorErrorEvidenceWeight * guess.sigma_s * guess.sigma_s);
      window_error_evidence.information(SensorErrors::kDelay, SensorErrors::kDelay) += information;
      window_error_evidence.gradient[SensorErrors::kDelay] += information * (guess.delay_s - delay.applied_delay_s);
    }
    delay.estimated_s = std::clamp(
        delay.applied_delay_s + sensor_error_uncertainty.delay_correction_s(window_error_evidence, max_accel_delay_s()),
        -max_accel_delay_s(), max_accel_delay_s());
  }
  sensor_error_uncertainty.update(window_error_evidence, posterior_workspace, device.posterior, delay.delay_found);
}

Matrix3d AngularRateStream::Impl::sensor_error_rate_covariance(std::size_t k, const State& state) const {
  const Knot& knot = state.window[k];
  if (!has_moved_states(knot)) return Matrix3d::Zero();
  const AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  Matrix3d out =
      rate_covariance_from_errors(device.sample_jacobian[k], device.posterior.covariance, params.model.kRateMax_rad_s);
  const double shared_s2 = sensor_error_uncertainty.common_delay_variance_s2(device.posterior);
  const Eigen::Vector3d& alpha = knot.estimate.knot.acceleration_rad_s2;
  const double struck = params.model.expert.contact.kGain_rad_m * knot.estimate.contact_force_m_s2.norm();
  out += shared_s2 * (alpha * alpha.transpose() + struck * struck * Matrix3d::Identity());
  return out;
}

}  // namespace tumble
