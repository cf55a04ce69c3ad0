// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <type_traits>

#include "frozen_members.hpp"
#include "rails_members.hpp"

#include "tumble/angular_velocity/rate_stream.hpp"

/// Members of a RateStream's state and of what its Params hold beside Fields: state_visitor.hpp.
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
  visit("auxiliary.rate_by_elements", s.rate_by_elements);
  visit("auxiliary.force_by_elements", s.force_by_elements);
}

template <StateOf<RateObservation> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("observation.sample", s.sample);
  visit("observation.clipping", s.clipping);
  visit("observation.at_rest", s.at_rest);
  visit("observation.subsample_saturated", s.subsample_saturated);
  visit("observation.lone", s.lone);
  visit("observation.doubted", s.doubted);
  visit("observation.lost_rad_s", s.lost_rad_s);
  visit("observation.lost_sigma_rad_s", s.lost_sigma_rad_s);
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
  visit("estimate.contact_m_s2", s.contact_m_s2);
  visit("estimate.bound_precision", s.bound_precision);
  visit("estimate.bound_shift", s.bound_shift);
  visit("estimate.soft_bounds", s.soft_bounds);
}

template <StateOf<RateStream::Knot> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("knot.observation", s.observation);
  visit("knot.by_upright_rails", s.by_upright_rails);
  visit("knot.estimate", s.estimate);
  visit("knot.covariance_rad2_s2", s.covariance_rad2_s2);
  visit("knot.approach_rad_s", s.approach_rad_s);
  visit("knot.age", s.age);
  visit("knot.repeats", s.repeats);
  visit("knot.held", s.held);
  visit("knot.near", s.near);
}

template <StateOf<FlightSense::Reading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("reading.time_ns", s.time_ns);
  visit("reading.rate_rad_s", s.rate_rad_s);
  visit("reading.force_m_s2", s.force_m_s2);
  visit("reading.free", s.free);
}

template <StateOf<FlightSense::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sense.average", s.average);
  visit("sense.before", s.before);
  visit("sense.readings", s.readings, 0.0, 2.0);
  visit("sense.run_s", s.run_s);
  visit("sense.flown_s", s.flown_s);
  visit("sense.last_time_ns", s.last_time_ns);
  visit("sense.started", s.started);
}

template <StateOf<SensorErrors> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("errors.gyro", s.gyro);
  visit("errors.accel", s.accel);
  visit("errors.felt_s_m", s.felt_s_m);
  visit("errors.accel_delay_s", s.accel_delay_s);
  visit("errors.accel_blur_s2", s.accel_blur_s2);
}

template <StateOf<KnownSensorErrors> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("known.errors", s.errors);
  visit("known.covariance", s.covariance);
}

template <StateOf<SensorErrorEvidence> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("evidence.about", s.about);
  visit("evidence.information", s.information);
  visit("evidence.gradient", s.gradient);
}

template <StateOf<RateStreamDevice> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("device.prior", s.prior);
  visit("device.corner", s.corner);
  visit("device.evidence", s.evidence);
  visit("device.covariance", s.open.covariance);
  visit("device.unlike", s.open.unlike);
  visit("device.asked_ns", s.asked_ns);
  visit.scratch(s.moved);
  visit.scratch(s.work);
}

template <StateOf<RateStream::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rate.rails", s.rails);
  visit("rate.rests", s.rests);
  visit("rate.holds", s.holds);
  visit("rate.frozen", s.frozen);
  visit("rate.sense", s.sense);
  visit("rate.window", s.window);
  visit("rate.rig", s.rig);
  visit("rate.rig_covariance", s.rig_covariance);
  visit("rate.prior", s.prior);
  visit("rate.prior_corner", s.prior_corner);
  visit("rate.device", s.device.front());
  visit("rate.extremes", s.extremes);
  visit("rate.least", s.least);
  visit("rate.entry_rad_s", s.entry_rad_s);
  visit("rate.entry_samples", s.entry_samples);
  visit("rate.left", s.left);
  visit("rate.left_ns", s.left_ns);
  visit("rate.prior_knot", s.prior_knot);
  visit("rate.prior_rig", s.prior_rig);
  visit("rate.samples", s.samples);
  visit("rate.waiting", s.waiting);
  visit("rate.learnt_from", s.learnt_from);
  visit("rate.flight_run", s.flight_run);
  visit("rate.rig_resets", s.rig_resets);
  visit("rate.failures", s.failures);
  visit.scratch(s.work);
}

template <StateOf<AuxiliaryImu> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("auxiliary.T_IC", s.T_IC);
  visit("auxiliary.gyro_noise_density", s.gyro_noise_density);
  visit("auxiliary.accel_noise_density", s.accel_noise_density);
  visit("auxiliary.gyro_error_rad_s", s.gyro_error_rad_s);
  visit("auxiliary.accel_error_m_s2", s.accel_error_m_s2);
  visit("auxiliary.share_error", s.share_error);
  visit("auxiliary.position_error_m", s.position_error_m);
  visit("auxiliary.clock_error_s", s.clock_error_s);
  visit("auxiliary.gyro_elements", s.gyro_elements);
  visit("auxiliary.accel_elements", s.accel_elements);
}

template <StateOf<RateModelParams> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit.with_nan("nominal", p.nominal);  // NaN where a door has its own
  visit("calibration", p.calibration);
  visit("auxiliary_imus", p.auxiliary_imus);
  visit("errors", p.errors);
}

template <StateOf<RateStream::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  others(p.model, visit);
  others(p.rails, visit);
  others(p.expert.planes, visit);
  others(p.expert.accel_planes, visit);
  std::optional<KnownSensorErrors> learnt;
  if (p.learnt_errors) learnt = *p.learnt_errors;
  visit("learnt_errors", learnt);
  if constexpr (Visitor::kReads && !std::is_const_v<Self>)
    p.learnt_errors = learnt ? std::make_shared<const KnownSensorErrors>(*learnt) : nullptr;
}

}  // namespace tumble
