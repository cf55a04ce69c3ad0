// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "possible_saturation.hpp"
#include "rate_stream_impl.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

int clipped_axes(const AngularRateObservation& o) {
  return o.unmeasured_axes();
}

FrozenAxes::ImuRanges stated_ranges(const SaturationLimitDetector::Params& rails) {
  return {.gyro_range_rad_s = rails.stated_gyro_range_rad_s.value_or(0.0),
          .accel_range_m_s2 = rails.stated_accel_range_m_s2.value_or(0.0)};
}

double seconds_between(const AngularRateStream::Knot& from, const AngularRateStream::Knot& to) {
  return seconds(to.observation.sample.time_ns - from.observation.sample.time_ns);
}

void clamp_to_bounds(const AngularRateObservation& o, Vector3d& rate) {
  for (int j = 0; j < 3; ++j) {
    if ((o.unmeasured_axes() & o.clipping.gyro & 1u << j) == 0) continue;
    const double reading = o.sample.angular_velocity_rad_s[j];
    rate[j] = reading < 0.0 ? std::min(rate[j], reading) : std::max(rate[j], reading);
  }
}

// See rate_stream.md (R91).
void add_prior(const AngularRateStream::State& state, const AngularRateModel& model, const AngularRateKnot& knot,
               arrow::Block& block, arrow::Corner& corner) {
  Eigen::Matrix<double, 6, 1> moved;
  moved << knot.rate_rad_s - state.prior_knot.rate_rad_s,
      knot.acceleration_rad_s2 - state.prior_knot.acceleration_rad_s2;
  const arrow::StateVector x = model.scaled_difference(moved);
  const arrow::BorderVector c = state.rig.vector() - state.prior_rig.vector();
  block.diagonal += state.prior.diagonal;
  block.border_coupling += state.prior.border_coupling;
  block.gradient += state.prior.gradient - state.prior.diagonal * x - state.prior.border_coupling * c;
  corner.matrix += state.prior_border_block.matrix;
  corner.gradient += state.prior_border_block.gradient - state.prior_border_block.matrix * c -
                     state.prior.border_coupling.transpose() * x;
}

AngularRateModelParams model_params_with_corrections(const AngularRateStreamParams& params) {
  AngularRateModelParams out = params.model;
  if (params.calibrated_errors) out.errors = params.calibrated_errors->errors;
  return out;
}

}  // namespace

AngularRateStream::Impl::Impl(const Params& given)
    : params(given),
      clipping_finder({params.saturation_detector, params.expert.gyro_planes, params.expert.accel_saturation_planes}),
      rest_detector(params.expert.rest_detector),
      frozen_axes(stated_ranges(params.saturation_detector)),
      flight_axis_sign_check({.lever_arm_m = params.model.nominal.lever_arm_m,
                              .gyro_range_rad_s = params.saturation_detector.stated_gyro_range_rad_s.value_or(0.0)}),
      model(model_params_with_corrections(params), params.period_s),
      sensor_error_uncertainty(params.model.expert.error_priors, params.expert.uncalibrated) {
  require_valid_fields(params);
  if (params.calibrated_errors) require_valid_known_errors(*params.calibrated_errors);
  require_in_interval("lag_s", params.lag_s, 2.0 * params.period_s, params.lag_max_s());
  window_knots = static_cast<std::size_t>(std::lround(params.lag_s / params.period_s)) + 1;
  prior_accelerometer_delay_s = model_params_with_corrections(params).errors.accel_delay_s;
  const SensorErrorPriors& sizes = params.model.expert.error_priors;
  delay_is_estimated =
      !params.calibrated_errors && sizes.delay_uncalibrated_s > sizes.delay_s && params.expert.uncalibrated > 0.0;
  samples_per_step =
      std::clamp(static_cast<std::size_t>(params.step_s / params.period_s + 1e-6), std::size_t{1}, window_knots);
}

AngularRateStream::AngularRateStream(const Params& params) : impl_(std::make_shared<const Impl>(params)) {}

AngularRateStream::State AngularRateStream::start() const {
  State state;
  state.clipping_state = impl_->clipping_finder.start();
  state.window.reserve(impl_->window_knots + impl_->samples_per_step);
  state.work_blocks.resize(impl_->window_knots + impl_->samples_per_step);
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  device.sample_jacobian.resize(impl_->window_knots + impl_->samples_per_step);
  impl_->sensor_error_uncertainty.reset(device.posterior);
  device.accel_delay_state.applied_delay_s = device.accel_delay_state.estimated_s = impl_->prior_accelerometer_delay_s;
  if (impl_->params.calibrated_errors) {
    device.posterior.covariance = impl_->params.calibrated_errors->covariance;
    device.posterior.uncalibrated_probability = 0.0;
  }
  state.rig = state.prior_rig = impl_->model.prior_constants();
  state.rig_covariance = impl_->model.prior_covariance();
  impl_->model.add_rig_prior(state.rig, state.prior_border_block);
  return state;
}

BodyImuCalibration AngularRateStream::body_imu_calibration(const State& state) const {
  return {state.rig, impl_->inflated_calibration_covariance(state)};
}

bool AngularRateStream::lever_arm_is_prior(const State& state) const {
  const BodyImuConstants::Matrix before = start().rig_covariance;
  return !(state.rig_covariance.topLeftCorner<3, 3>().trace() < before.topLeftCorner<3, 3>().trace());
}

Status AngularRateStream::push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
                               std::optional<AngularRateState>& out) const {
  out.reset();
  if (!auxiliary_imus.empty() && auxiliary_imus.size() != impl_->params.model.auxiliary_imus.size()) {
    return {ErrorCode::insufficient_data, "auxiliary_imus", static_cast<double>(auxiliary_imus.size()),
            static_cast<double>(impl_->params.model.auxiliary_imus.size())};
  }
  if (Status status = check_sample(sample); !status.ok()) return status;
  if (!state.window.empty()) {
    Status status =
        check_stamp_order(sample.time_ns, state.window.back().observation.sample.time_ns, impl_->params.kGapMax_s);
    if (!status.ok()) return status;
  }
  const bool due = ++state.samples_since_step >= impl_->samples_per_step;
  if (due) impl_->marginalise_oldest_knots(state);
  impl_->append_knot(sample, auxiliary_imus, state);
  if (due) impl_->update_delay(state);
  if (!due) {
    impl_->predict_covariance(state);
  } else if (impl_->compute_flight_weight(state); !impl_->step(state)) {
    ++state.failures;
  }
  if (state.window.size() >= impl_->window_knots)
    out = impl_->rate_state_of_knot(state.window.size() - impl_->window_knots, state);
  return {};
}

void AngularRateStream::Impl::marginalise_oldest_knots(State& state) const {
  state.samples_since_step = 0;
  std::size_t count = 0;
  for (; state.window.size() - count >= window_knots; ++count) {
    store_slope_before_clipping(state.window[count], state.window[count + 1], state);
    marginalise(count, state);
  }
  state.window.erase(state.window.begin(), state.window.begin() + static_cast<std::ptrdiff_t>(count));
}

// For clipped axes, the covariance assumes the largest possible angular acceleration since the previous sample.
void AngularRateStream::Impl::predict_covariance(State& state) const {
  Knot& newest = state.window.back();
  const Knot& before = state.window[state.window.size() - std::min<std::size_t>(2, state.window.size())];
  const double turned = params.model.kAccelerationMax_rad_s2 * seconds_between(before, newest);
  Vector3d sigma = Vector3d::Constant(model.gyro_sigma_rad_s());
  for (int j = 0; j < 3; ++j) sigma[j] = (clipped_axes(newest.observation) >> j & 1) != 0 ? turned : sigma[j];
  newest.covariance_rad2_s2 = before.covariance_rad2_s2;
  newest.covariance_rad2_s2 += sigma.cwiseAbs2().asDiagonal();
}

// See rate_stream.md (R90), (R92).
void AngularRateStream::Impl::marginalise(std::size_t first, State& state) const {
  Knot& oldest = state.window[first];
  const Knot& next = state.window[first + 1];
  arrow::Block block, after;
  arrow::Corner corner;
  add_prior(state, model, oldest.estimate.knot, block, corner);
  const double after_it = model.jump(oldest.estimate.knot, next.estimate.knot, seconds_between(oldest, next));
  const double jump = std::min(rate_change_since_marginalised(oldest, state), after_it);
  model.compute_flight_weight(oldest.observation, state.rig, BodyImuConstants::Matrix::Zero(), 1.0, jump,
                              oldest.estimate);
  // Free flights of few samples do not update the calibration. A short contact may be mistaken for free flight, because
  // 20 calibration constants can fit a few arbitrary readings.
  std::size_t run = state.consecutive_flight_samples;
  const auto needed = params.expert.kFlightRunMin;
  const auto flies = [](const Knot& knot) { return knot.estimate.flight_weight >= 0.5; };
  for (std::size_t k = first; k < state.window.size() && run < needed && flies(state.window[k]); ++k) ++run;
  const bool short_flight = run < needed;
  state.consecutive_flight_samples = flies(oldest) ? state.consecutive_flight_samples + 1 : 0;
  if (!short_flight && flies(oldest)) ++state.calibration_samples;
  model.add_sample(oldest.observation, oldest.estimate, state.rig, block, corner,
                   short_flight ? &state.rig_covariance : nullptr);
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  arrow::ErrorMatrix errors = device.prior;
  model.add_sensor_errors(oldest.observation, oldest.estimate, state.rig, errors, device.border_errors,
                          device.sensor_error_evidence, short_flight);
  model.add_motion_model(oldest.estimate, next.estimate, seconds_between(oldest, next), block, after);
  if (arrow::System::eliminate(block, &after, corner)) {
    state.prior = after;
    state.prior_border_block = corner;
    marginalise_sensor_errors(block, errors, state);
  } else {
    discard_marginalised_information(state);
    ++state.failures;
  }
  state.last_marginalised = oldest.estimate.knot;
  state.last_marginalised_ns = oldest.observation.sample.time_ns;
  state.prior_knot = next.estimate.knot;
  state.prior_rig = state.rig;
  if (model.calibration_mahalanobis(state.rig) > params.calibration_mahalanobis_max) {
    // If the estimated calibration is implausible, contact was probably classified as free flight.
    reset_rig(state);
    ++state.calibration_reset_count;
  }
}

double AngularRateStream::Impl::rate_change_since_marginalised(const Knot& oldest, const State& state) const {
  if (!state.last_marginalised) return std::numeric_limits<double>::max();
  return model.jump(*state.last_marginalised, oldest.estimate.knot,
                    seconds(oldest.observation.sample.time_ns - state.last_marginalised_ns));
}

void AngularRateStream::Impl::append_knot(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus,
                                          State& state) const {
  frozen_axes.step(sample, state.frozen_axes);
  flight_axis_sign_check.step(sample, state.flight_sign_check);
  const bool changed = clipping_finder.observe_reading(sample, state.clipping_state);
  Knot knot;
  knot.clipping_at_axis_limits = clipping_finder.axis_limit_detector().classify_clipping(
      sample, state.clipping_state.known_limits.axis_limit_state);
  repeat_detector.observe_reading(sample,
                                  (knot.clipping_at_axis_limits.gyro | knot.clipping_at_axis_limits.unusable_gyro) != 0,
                                  state.repetition_state);
  knot.observation = {
      sample, knot.clipping_at_axis_limits,
      rest_detector.detect_stationary(sample, state.stationary_state, params.model.nominal.gyro_bias_rad_s)};
  knot.received_force = {sample.specific_force_m_s2, static_cast<std::uint8_t>(sample.device_clip_flags & kClipAccel),
                         knot.clipping_at_axis_limits.accel};
  std::copy(auxiliary_imus.begin(), auxiliary_imus.end(), knot.observation.auxiliary_imus.begin());
  const RepeatedReading& repeated = state.repetition_state.for_triad(Triad::gyro);
  knot.repeats_reading = repeated.repeats_reading && !knot.observation.at_rest;
  if (!knot.observation.at_rest) knot.repeated = repeated;
  knot.estimate.knot.rate_rad_s = sample.angular_velocity_rad_s;
  knot.covariance_rad2_s2 = std::pow(params.model.kRateMax_rad_s, 2) * Eigen::Matrix3d::Identity();
  state.window.push_back(knot);
  state.window.back().plateau_growth_rad_s = min_recent_increase_rad_s(state.window);
  const std::size_t paired = pair_newest_force(state);
  ++state.samples;
  if (knot.clipping_at_axis_limits.unusable_gyro == 0) state.min_saturation_levels.add(sample.angular_velocity_rad_s);
  if (changed) reclassify_window_clipping(state);
  classify_clipping_from(changed ? 0 : paired, state);
  add_impact_to_delay_correlation(state);
  state.reading_extremes_rad_s[0] = state.reading_extremes_rad_s[0].cwiseMin(sample.angular_velocity_rad_s);
  state.reading_extremes_rad_s[1] = state.reading_extremes_rad_s[1].cwiseMax(sample.angular_velocity_rad_s);
  mark_possible_saturation(state);
}

// The initial rate of a clipped sample is the predicted rate or the rate from the centripetal force, whichever agrees
// better with free flight.
void AngularRateStream::Impl::predict_new_knot(Knot& knot, const Knot& previous, const State& state) const {
  const double dt_s = seconds_between(previous, knot);
  const AngularRateKnot& before = previous.estimate.knot;
  const int clipped = clipped_axes(knot.observation);
  knot.estimate.knot.acceleration_rad_s2 = before.acceleration_rad_s2;
  if (clipped == 0) return;
  Vector3d predicted = before.rate_rad_s + dt_s * before.acceleration_rad_s2;
  Vector3d shape = predicted, unclipped = knot.observation.sample.angular_velocity_rad_s - state.rig.gyro_bias_rad_s;
  for (int j = 0; j < 3; ++j) {
    if ((clipped >> j & 1) == 0) {
      predicted[j] = unclipped[j];
      shape[j] = 0.0;
    } else {
      unclipped[j] = 0.0;
    }
  }
  clamp_to_bounds(knot.observation, predicted);
  clamp_to_bounds(knot.observation, shape);
  Knot centripetal = knot;
  knot.estimate.knot.rate_rad_s = predicted;
  const double speed = predicted.norm();
  if (!(speed > 0.0) || !(shape.norm() > 0.0)) return;
  const Vector3d axis = predicted / speed, &t = state.rig.lever_arm_m;
  const Vector3d to_axis = t.dot(axis) * axis - t;
  const double squared =
      to_axis.dot(knot.observation.sample.specific_force_m_s2) / to_axis.squaredNorm() - unclipped.squaredNorm();
  if (!(squared > 0.0)) return;
  Vector3d rate = unclipped + std::sqrt(squared) * shape.normalized();
  clamp_to_bounds(knot.observation, rate);
  const double largest = params.model.kRateMax_rad_s;
  centripetal.estimate.knot.rate_rad_s = rate.cwiseMin(largest).cwiseMax(-largest);
  model.compute_flight_weight(knot.observation, state.rig, state.rig_covariance, 1.0, 0.0, knot.estimate);
  model.compute_flight_weight(knot.observation, state.rig, state.rig_covariance, 1.0, 0.0, centripetal.estimate);
  // The previous angular acceleration may be wrong, because an impact changes the angular acceleration abruptly.
  // search_flight_solutions() computes the angular acceleration from Euler's equation without torque instead.
  model.search_flight_solutions(knot.observation, state.rig, centripetal.estimate);
  model.compute_flight_weight(knot.observation, state.rig, state.rig_covariance, 1.0, 0.0, centripetal.estimate);
  if (centripetal.estimate.flight_weight > knot.estimate.flight_weight) knot.estimate = centripetal.estimate;
}

void AngularRateStream::Impl::compute_flight_weight(State& state) const {
  constexpr double kNone = std::numeric_limits<double>::max();
  double before = rate_change_since_marginalised(state.window.front(), state);
  for (std::size_t k = 0; k < state.window.size(); ++k) {
    Knot& knot = state.window[k];
    double after = kNone;
    if (k + 1 < state.window.size()) {
      const Knot& next = state.window[k + 1];
      after = model.jump(knot.estimate.knot, next.estimate.knot, seconds_between(knot, next));
    }
    const bool clipped = clipped_axes(knot.observation) != 0;
    const double threshold_factor =
        clipped ? std::max(1.0, std::ldexp(params.expert.kInitialThresholdFactor, -knot.knot_age_samples)) : 1.0;
    model.compute_flight_weight(knot.observation, state.rig, state.rig_covariance, threshold_factor,
                                std::min(before, after), knot.estimate);
    const bool soften = knot.knot_age_samples >= params.expert.bound_hard_steps && knot.estimate.flight_weight < 0.5;
    if (soften && !knot.estimate.use_soft_bounds) {
      model.search_flight_solutions(knot.observation, state.rig, knot.estimate);
      model.initialise_rate_bounds(knot.observation, state.rig, knot.estimate);
    }
    before = after;
  }
}

// See rate_smoother.md (R26) to (R35).
bool AngularRateStream::Impl::step(State& state) const {
  const std::size_t count = state.window.size();
  std::vector<arrow::Block>& blocks = state.work_blocks;
  arrow::Corner corner;
  blocks[0] = {};
  add_prior(state, model, state.window[0].estimate.knot, blocks[0], corner);
  add_misalignment_prior(state, corner);
  for (std::size_t k = 0; k < count; ++k) {
    const Knot& knot = state.window[k];
    model.add_sample(knot.observation, knot.estimate, state.rig, blocks[k], corner);
    const bool last = k + 1 == count;
    if (!last) {
      const Knot& next = state.window[k + 1];
      blocks[k + 1] = {};
      model.add_motion_model(knot.estimate, next.estimate, seconds_between(knot, next), blocks[k], blocks[k + 1]);
    }
    if (!arrow::System::eliminate(blocks[k], last ? nullptr : &blocks[k + 1], corner)) return false;
  }
  arrow::BorderVector rig_step;
  arrow::BorderMatrix rig_covariance;
  if (!arrow::System::solve_border_block(corner, rig_step, rig_covariance)) return false;
  state.rig_covariance = rig_covariance;
  add_sensor_error_covariance(rig_step, state);
  state.rig.add(rig_step);
  const arrow::BorderMatrix rig_spread = inflated_calibration_covariance(state);
  arrow::StateVector x;
  arrow::Conditional conditional;
  for (std::size_t k = count; k-- > 0;) {
    Knot& knot = state.window[k];
    const bool last = k + 1 == count;
    x = arrow::System::back_substitute(blocks[k], last ? nullptr : &x, rig_step);
    conditional = arrow::System::state_given_next_state(blocks[k], last ? nullptr : &conditional);
    const Eigen::Matrix<double, 6, 1> physical = model.unscaled_step(x);
    const double share = std::min(1.0, params.expert.kStepMax_rad_s / std::max(1e-300, physical.head<3>().norm()));
    knot.estimate.knot.rate_rad_s += share * physical.head<3>();
    knot.estimate.knot.acceleration_rad_s2 += share * physical.tail<3>();
    knot.covariance_rad2_s2 = arrow::rate_covariance(conditional, rig_spread) + sensor_error_rate_covariance(k, state);
    if (knot.estimate.use_soft_bounds) {
      model.update_bounds(knot.observation, state.rig, conditional, rig_covariance, params.expert.kBoundDamping,
                          knot.estimate);
    }
    ++knot.knot_age_samples;
  }
  return true;
}

// See rate_stream.md (R97).
BodyImuConstants::Matrix AngularRateStream::Impl::inflated_calibration_covariance(const State& state) const {
  if (params.model.calibration) return state.rig_covariance;
  const double samples = static_cast<double>(state.calibration_samples) * model.independent_sample_fraction() /
                         params.expert.inflation.kSamples;
  const double largest = std::sqrt(1.0 + params.expert.inflation.covariance / (1.0 + samples));
  BodyImuConstants::Vector factor;
  for (int i = 0; i < BodyImuConstants::kSize; ++i) {
    // The variance of the gyro bias is not increased, because readings at rest determine the gyro bias.
    const bool of_gyro = i >= 3 && i < 6;
    const double before = std::sqrt(model.prior_covariance()(i, i) / state.rig_covariance(i, i));
    factor[i] = of_gyro ? 1.0 : std::clamp(before, 1.0, largest);
  }
  return factor.asDiagonal() * state.rig_covariance * factor.asDiagonal();
}

SensorHealth AngularRateStream::health(const State& state) const {
  SensorHealth out;
  impl_->frozen_axes.add_findings(HealthFinding::Kind::frozen_axis, "imu", state.frozen_axes, out);
  out.add(HealthFinding::Kind::inverted_accel_in_flight,
          impl_->flight_axis_sign_check.current_verdict(state.flight_sign_check), "imu");
  return out;
}

}  // namespace tumble
