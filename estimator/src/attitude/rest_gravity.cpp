// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/rest_gravity.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// The limits of the rest detector are wide, because the unit of the specific force and the gyro bias are unknown.
constexpr RestDetector::Params kRests{.rate_max_rad_s = 0.15, .caller_settings = {.force_min_m_s2 = 0.3}};
// tolerated relative error of measured gravity, for up to 80 mg of accelerometer bias and 3 % of scale error
constexpr double kMagnitudeErrorMax = 0.15;
// The tolerance of the angle between measured and expected gravity includes errors from gyro bias, and from pushes at
// rest.
constexpr double kAngleMax_sigmas = 5.0, kAngleToleranceMin_rad = 0.3, kAngleToleranceMax_rad = 0.6;
constexpr double kCorrelation_s = 0.1;  // minimum correlation time of a gyro rate's error
// minimum rotation between two compared rests; with less rotation, most sensor faults remain undetected
constexpr double kSpanRotationMin_rad = 1.0;
constexpr double kSpanMax_s = 60.0;    // longest time between compared rests, because the gyro bias drifts
constexpr double kRestGapMax_s = 0.1;  // an impact may hide in a longer data gap
constexpr double kRested_s = 1.0;      // total duration of rest that the check of gravity's magnitude needs
// minimum ratio of measured to expected gravity, or of expected to measured gravity, that indicates a wrong unit
constexpr double kWrongUnitRatio = 3.0;

RestDetector::Params without_force_limits() {
  RestDetector::Params rests = kRests;
  rests.caller_settings.force_max_m_s2 = rests.caller_settings.force_min_m_s2;
  rests.caller_settings.force_min_m_s2 = 0.0;
  return rests;
}

/// A specific force has a larger numerical value in mg, cm/s^2 or counts than in m/s^2. If readings at rest are far
/// above gravity, the unit is wrong, because no robot is stationary at ten times gravity.
RestDetector::Params params_for_large_units() {
  constexpr double kLarger = 100.0;
  RestDetector::Params rests = kRests;
  rests.caller_settings.force_min_m_s2 = kLarger;
  rests.caller_settings.force_max_m_s2 = 1e6;
  rests.force_spread_m_s2 = std::min(kLarger * rests.force_spread_m_s2, 1e6);
  return rests;
}

/// See imu_merge.md (I24).
double allowed_rad(double sigma_rad) {
  return std::min(kAngleToleranceMax_rad, std::max(kAngleToleranceMin_rad, kAngleMax_sigmas * sigma_rad));
}

/// Returns the mean magnitude of the specific force at rest as a fraction of gravity. Returns 0 if the accelerometer
/// measured nearly zero force during rest, and 1 if the body rested for less than kRested_s.
double gravity_magnitude_error_ratio(const RestGravity::GravityMagnitudeState& state, double gravity_m_s2) {
  if (state.rest_s >= kRested_s) return state.stationary_force_integral_m_s / state.rest_s / gravity_m_s2;
  return state.weightless_s >= kRested_s ? 0.0 : 1.0;
}

}  // namespace

RestGravity::RestGravity(const Setup& setup)
    : setup_(setup), detector_(kRests), weightless_(without_force_limits()), above_gravity_(params_for_large_units()) {
  require_in_interval("gravity_m_s2", setup.gravity_m_s2, 1e-12, 100.0);
  require_in_interval("accel_range_m_s2", setup.accel_range_m_s2, 0.0, kUnbounded);
}

RestGravity::Step RestGravity::detect_stationary_periods(const ImuSample& sample, GravityMagnitudeState& state) const {
  if (!check_sample(sample).ok()) return {};
  double dt_s = 0.0;
  const Status follows =
      state.started ? elapsed_time_since_last(sample.time_ns, state.last_time_ns, kRestGapMax_s, dt_s) : Status{};
  if (follows.error_code == ErrorCode::time_order) return {};
  state.started = true;
  state.last_time_ns = sample.time_ns;
  if (!follows.ok()) {
    state.stationary_state = state.stationary_weightless = state.stationary_above_gravity = {};
    state.is_stationary = false;
  }
  if (weightless_.detect_stationary(sample, state.stationary_weightless)) state.weightless_s += dt_s;
  const bool above_gravity = above_gravity_.detect_stationary(sample, state.stationary_above_gravity);
  state.is_stationary = detector_.detect_stationary(sample, state.stationary_state);
  if (state.is_stationary || above_gravity) {
    state.rest_s += dt_s;
    state.stationary_force_integral_m_s += dt_s * sample.specific_force_m_s2.norm();
  }
  return {follows.ok() ? SampleContinuity::consecutive : SampleContinuity::after_gap, dt_s};
}

void RestGravity::step(const ImuSample& sample, const AngularRateState& rate, State& state) const {
  const bool before = state.is_stationary;
  const auto [follows, dt_s] = detect_stationary_periods(sample, state);
  if (follows == SampleContinuity::not_comparable) return;
  if (follows == SampleContinuity::after_gap) state.last_rest_force_m_s2.setZero();
  const bool rested = before && follows == SampleContinuity::consecutive;
  if (!state.is_stationary) {
    integrate_rotation(sample, rate, dt_s, state);
    if (rate.source != AngularRateSource::measured) {
      state.unmeasured_duration_s += dt_s;
      state.unmeasured_rotation_variance += dt_s * rate.covariance_rad2_s2.trace();
    } else {
      end_segment(state);
      state.angle_variance_rad2 += dt_s * kCorrelation_s * rate.covariance_rad2_s2.trace();
    }
    return;
  }
  if (!rested) finish_rest_pair(state);
  state.last_rest_force_m_s2 = state.stationary_state.mean_force_m_s2();
  state.rotation.setIdentity();
  state.integrated_force_m_s.setZero();
  state.span_s = state.integrated_saturation_deficit_m_s = 0.0;
  state.angle_since_last_rest_rad = state.angle_variance_rad2 = state.unmeasured_duration_s =
      state.unmeasured_rotation_variance = 0.0;
}

/// See imu_merge.md (I25). An accelerometer reading is the mean over the averaging window, and is valid at the middle
/// of the averaging window.
void RestGravity::integrate_rotation(const ImuSample& sample, const AngularRateState& rate, double dt_s,
                                     State& state) const {
  const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * rate.w_WI_I_rad_s);
  const Eigen::Vector3d& force = sample.specific_force_m_s2;
  state.integrated_force_m_s += dt_s * ((state.rotation * half) * force);
  state.rotation = (state.rotation * half * half).normalized();
  state.angle_since_last_rest_rad += dt_s * rate.w_WI_I_rad_s.norm();
  state.span_s += dt_s;
  const double peak = force.cwiseAbs().maxCoeff();
  const bool at_range = setup_.accel_range_m_s2 > 0.0 && peak >= (1.0 - kNearRailRatio) * setup_.accel_range_m_s2;
  if (at_range || (sample.device_clip_flags & kClipAccel) != 0) state.integrated_saturation_deficit_m_s += dt_s * peak;
}

/// The rate errors within one clipped segment are assumed correlated: imu_merge.md (I23).
void RestGravity::end_segment(State& state) const {
  state.angle_variance_rad2 +=
      std::max(kCorrelation_s, state.unmeasured_duration_s) * state.unmeasured_rotation_variance;
  state.unmeasured_duration_s = state.unmeasured_rotation_variance = 0.0;
}

/// See imu_merge.md (I25), (I26).
void RestGravity::finish_rest_pair(State& state) const {
  end_segment(state);
  if (state.last_rest_force_m_s2.isZero(0.0) || state.angle_since_last_rest_rad < kSpanRotationMin_rad ||
      state.span_s > kSpanMax_s)
    return;
  ++state.compared_rest_pairs;
  const Eigen::Vector3d current_force_m_s2 = state.stationary_state.mean_force_m_s2();
  const Eigen::Vector3d mean_m_s2 = state.integrated_force_m_s / state.span_s;
  const double from_start = (mean_m_s2 - state.last_rest_force_m_s2).norm() / state.last_rest_force_m_s2.norm();
  const double from_end =
      (state.rotation.conjugate() * mean_m_s2 - current_force_m_s2).norm() / current_force_m_s2.norm();
  const double share = from_start + from_end;
  const double hidden =
      2.0 * state.integrated_saturation_deficit_m_s / (state.span_s * state.last_rest_force_m_s2.norm());
  const double allowed = std::hypot(allowed_rad(std::sqrt(state.angle_variance_rad2)), hidden);
  if (share * state.worst_pair_error_limit < state.worst_velocity_error_ratio * allowed) return;
  state.worst_velocity_error_ratio = share;
  state.worst_pair_error_limit = allowed;
}

void RestGravity::limit_memory(GravityMagnitudeState& state) {
  constexpr double kForgettingTime_s = 60.0;
  if (state.rest_s <= kForgettingTime_s) return;
  state.rest_s *= 0.5;
  state.stationary_force_integral_m_s *= 0.5;
}

Status RestGravity::gravity_magnitude_verdict(const GravityMagnitudeState& state) const {
  const double size = gravity_magnitude_error_ratio(state, setup_.gravity_m_s2);
  if (std::abs(size - 1.0) > kMagnitudeErrorMax) {
    const bool unit = size > 0.0 && (size < 1.0 / kWrongUnitRatio || size > kWrongUnitRatio);
    return {ErrorCode::out_of_range,
            unit ? "accelerometer unit: specific force at rest (share of gravity)"
                 : "specific force at rest (share of gravity)",
            size, 1.0 + std::copysign(kMagnitudeErrorMax, size - 1.0)};
  }
  return {};
}

Status RestGravity::verdict(const State& state) const {
  if (const Status size = gravity_magnitude_verdict(state); !size.ok()) return size;
  if (state.worst_velocity_error_ratio > state.worst_pair_error_limit) {
    return {ErrorCode::out_of_range,
            "velocity error after integration from one rest to the next (share of gravity times elapsed time)",
            state.worst_velocity_error_ratio, state.worst_pair_error_limit};
  }
  return {};
}

}  // namespace tumble
