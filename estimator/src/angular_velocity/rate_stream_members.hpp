// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <type_traits>

#include "frozen_members.hpp"
#include "rails_members.hpp"
#include "rate_model_members.hpp"

#include "tumble/angular_velocity/rate_stream.hpp"

/// rate_stream_members.hpp lists the members of RateStream's state and further members of RateStream::Params, for
/// saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<RateStreamForce> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("read.force_m_s2", s.force_m_s2);
  visit("read.device_clip_flags", s.device_clip_flags);
  visit("read.clipped", s.clipped);
}

template <StateOf<RateStream::Knot> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("knot.observation", s.observation);
  visit("knot.read", s.read);
  visit("knot.by_upright_rails", s.by_axis_aligned_rails);
  visit("knot.estimate", s.estimate);
  visit("knot.covariance_rad2_s2", s.covariance_rad2_s2);
  visit("knot.approach_rad_s", s.reading_growth_rad_s);
  visit("knot.age", s.age);
  visit("knot.repeats", s.repeats);
  visit("knot.repeated", s.repeated);
  visit("knot.near", s.near);
}

template <StateOf<FlightSignCheck::Reading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("reading.time_ns", s.time_ns);
  visit("reading.rate_rad_s", s.rate_rad_s);
  visit("reading.force_m_s2", s.force_m_s2);
  visit("reading.at_rail", s.at_rail);
  visit("reading.known", s.known);
}

template <StateOf<FlightSignCheck::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sense.average", s.average);
  visit("sense.before", s.before);
  visit("sense.readings", s.readings, 0.0, 2.0);
  visit("sense.run_s", s.run_s);
  visit("sense.flown_s", s.flight_duration_s);
  visit("sense.flown_ns", s.last_flight_end_ns);
  visit("sense.last_time_ns", s.last_time_ns);
  visit("sense.started", s.started);
}

template <StateOf<ImpactSums> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("strokes.intervals", s.intervals);
  visit("strokes.turn", s.acceleration_sum);
  visit("strokes.turn_squared", s.acceleration_squared);
  visit("strokes.force", s.force);
  visit("strokes.force_squared", s.force_squared);
  visit("strokes.product", s.product);
  visit("strokes.strokes", s.impacts);
  visit("strokes.flying", s.flying);
}

template <StateOf<RateStreamDelay> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("delay.strokes", s.impacts);
  visit("delay.in_use_s", s.applied_delay_s);
  visit("delay.estimated_s", s.estimated_s);
  visit("delay.found", s.found);
  visit("delay.guess_s", s.guess.delay_s);
  visit("delay.guess_sigma_s", s.guess.sigma_s);
  visit("delay.updated_ns", s.updated_ns);
}

template <StateOf<RateStreamDevice> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("device.prior", s.prior);
  visit("device.corner", s.corner);
  visit("device.evidence", s.evidence);
  visit("device.covariance", s.posterior.covariance);
  visit("device.unlike", s.posterior.uncalibrated_probability);
  visit("device.updated_ns", s.updated_ns);
  visit("device.delay", s.delay);
  visit.scratch(s.moved);
  visit.scratch(s.work);
}

template <StateOf<RateStream::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rate.rails", s.rails);
  visit("rate.rests", s.rests);
  visit("rate.repeat_state", s.repeat_state);
  visit("rate.frozen", s.frozen);
  visit("rate.sense", s.sense);
  visit("rate.window", s.window);
  visit("rate.rig", s.rig);
  visit("rate.rig_covariance", s.rig_covariance);
  visit("rate.prior", s.prior);
  visit("rate.prior_corner", s.prior_corner);
  visit("rate.device", s.device.front());
  visit("rate.extremes", s.extremes);
  visit("rate.least", s.min_levels);
  visit("rate.entry_rad_s", s.slope_before_clipping_rad_s);
  visit("rate.entry_samples", s.entry_samples);
  visit("rate.left", s.last_marginalised);
  visit("rate.left_ns", s.last_marginalised_ns);
  visit("rate.prior_knot", s.prior_knot);
  visit("rate.prior_rig", s.prior_rig);
  visit("rate.samples", s.samples);
  visit("rate.waiting", s.samples_since_step);
  visit("rate.calibration_samples", s.calibration_samples);
  visit("rate.flight_run", s.flight_run);
  visit("rate.rig_resets", s.rig_resets);
  visit("rate.failures", s.failures);
  visit.scratch(s.work);
}

template <StateOf<RateStream::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  others(p.model, visit);
  others(p.rails, visit);
  others(p.expert.planes, visit);
  others(p.expert.accel_planes, visit);
  std::optional<KnownSensorErrors> learnt;
  if (p.calibrated_errors) learnt = *p.calibrated_errors;
  visit("calibrated_errors", learnt);
  if constexpr (Visitor::kReads && !std::is_const_v<Self>)
    p.calibrated_errors = learnt ? std::make_shared<const KnownSensorErrors>(*learnt) : nullptr;
}

}  // namespace tumble
