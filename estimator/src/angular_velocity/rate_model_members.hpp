// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/imu_members.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/sensor_errors.hpp"

namespace tumble {

template <StateOf<RateState> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rate.time_ns", s.time_ns);
  visit("rate.w_WI_I_rad_s", s.w_WI_I_rad_s);
  visit("rate.covariance_rad2_s2", s.covariance_rad2_s2);
  visit("rate.clipped_axes", s.clipped_axes);
  visit("rate.source", s.source, RateSource::bounded_only);
}

template <StateOf<RateKnot> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("knot.rate_rad_s", s.rate_rad_s);
  visit("knot.acceleration_rad_s2", s.acceleration_rad_s2);
}

template <StateOf<RigConstants> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rig.lever_arm_m", s.lever_arm_m);
  visit("rig.gyro_bias_rad_s", s.gyro_bias_rad_s);
  visit("rig.accel_bias_m_s2", s.accel_bias_m_s2);
  visit("rig.inertia", s.inertia);
  visit("rig.elements", s.elements);
}

template <StateOf<RigCalibration> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("calibration.constants", s.constants);
  visit("calibration.covariance", s.covariance);
}

template <StateOf<AuxiliaryReading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit.with_nan("auxiliary.rate_rad_s", s.rate_rad_s);
  visit.with_nan("auxiliary.force_m_s2", s.force_m_s2);
  visit.with_nan("auxiliary.rate_sigma_rad_s", s.rate_sigma_rad_s);
  visit.with_nan("auxiliary.force_sigma_m_s2", s.force_sigma_m_s2);
  visit("auxiliary.rate_along_elements", s.rate_along_elements);
  visit("auxiliary.force_along_elements", s.force_along_elements);
}

template <StateOf<RateObservation> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("observation.sample", s.sample);
  visit("observation.clipping", s.clipping);
  visit("observation.at_rest", s.at_rest);
  visit("observation.subsample_saturated", s.subsample_saturated);
  visit("observation.lone", s.isolated_high_axes);
  visit("observation.suspect", s.suspect);
  visit("observation.lost_rad_s", s.expected_deficit_rad_s);
  visit("observation.lost_sigma_rad_s", s.expected_deficit_sigma_rad_s);
  visit("observation.gyro_age_s", s.gyro_age_s);
  visit("observation.accel_age_s", s.accel_age_s);
  visit("observation.gyro_repeats", s.gyro_repeats);
  visit("observation.accel_rows", s.accel_rows);
  visit("observation.auxiliary_imus", s.auxiliary_imus);
}

template <StateOf<RateEstimate> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("estimate.knot", s.knot);
  visit("estimate.flight_weight", s.flight_weight);
  visit("estimate.contact_m_s2", s.contact_force_m_s2);
  visit("estimate.bound_precision", s.bound_precision);
  visit("estimate.bound_shift", s.bound_shift);
  visit("estimate.soft_bounds", s.soft_bounds);
}

template <StateOf<SensorErrors> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("errors.gyro", s.gyro);
  visit("errors.accel", s.accel);
  visit("errors.g_sensitivity_s_m", s.g_sensitivity_s_m);
  visit("errors.accel_delay_s", s.accel_delay_s);
  visit("errors.accel_filter_time_variance_s2", s.accel_filter_time_variance_s2);
}

template <StateOf<KnownSensorErrors> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("known.errors", s.errors);
  visit("known.covariance", s.covariance);
}

template <StateOf<SensorErrorEvidence> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("evidence.about", s.linearisation_point);
  visit("evidence.information", s.information);
  visit("evidence.gradient", s.gradient);
}

template <StateOf<AuxiliaryImu> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("auxiliary.T_IC", s.T_IC);
  visit("auxiliary.gyro_noise_density", s.gyro_noise_density);
  visit("auxiliary.accel_noise_density", s.accel_noise_density);
  visit("auxiliary.gyro_error_rad_s", s.gyro_error_rad_s);
  visit("auxiliary.accel_error_m_s2", s.accel_error_m_s2);
  visit("auxiliary.share_error", s.scale_error);
  visit("auxiliary.position_error_m", s.position_error_m);
  visit("auxiliary.clock_error_s", s.clock_error_s);
  visit("auxiliary.gyro_elements", s.gyro_elements);
  visit("auxiliary.accel_elements", s.accel_elements);
}

template <StateOf<RateModelParams> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit.with_nan("nominal", p.nominal);  // NaN until the caller sets the value
  visit("calibration", p.calibration);
  visit("auxiliary_imus", p.auxiliary_imus);
  visit("errors", p.errors);
}

}  // namespace tumble
