// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "../common/imu_members.hpp"
#include "sample_hold_bounds.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"

namespace tumble {

template <StateOf<RestDetector::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rest.rate_sum_rad_s", s.rate_sum_rad_s);
  visit("rest.force_sum_m_s2", s.force_sum_m_s2);
  visit("rest.weight", s.weight);
  visit("rest.first_ns", s.first_ns);
  visit("rest.last_mean_ns", s.last_mean_ns);
  visit("rest.within_bias_since_ns", s.within_bias_since_ns);
  visit("rest.rests", s.rests);
  visit("rest.pending_rate_rad_s", s.pending_rate_rad_s);
  visit("rest.pending_force_m_s2", s.pending_force_m_s2);
  visit("rest.pending_samples", s.pending_samples);
  visit("rest.pending_first_ns", s.pending_first_ns);
  visit("rest.last_reading_ns", s.last_reading_ns);
  visit("rest.last_ns", s.last_ns);
  visit("rest.started", s.started);
}

template <StateOf<RepeatedReading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("held.repeats", s.repeats);
  visit("held.age_samples", s.age_samples, 0.0, sample_hold::kSlowest);
  visit("held.period_samples", s.period_samples, 1.0, sample_hold::kSlowest);
  visit("held.change", s.change);
}

template <StateOf<RepeatDetector::Memory> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("hold.reading", s.reading);
  visit("hold.run_samples", s.equal_samples, 0.0, std::numeric_limits<double>::max());
  visit("hold.moving", s.moving, 0.0, 2.0 * sample_hold::kMovingMax);
  visit("hold.repeated", s.repeated, 0.0, s.moving);
  visit("hold.now", s.now);
}

template <StateOf<RepeatDetector::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("holds.memory", s.memory);
}

template <StateOf<Clipping> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("clipping.gyro", s.gyro);
  visit("clipping.accel", s.accel);
  visit("clipping.missing_gyro", s.unusable_gyro);
}

template <StateOf<RailDetector::Channel> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("channel.rail", s.rail);
  visit("channel.peak", s.peak);
  visit("channel.run_first", s.run_first);
  visit("channel.run_length", s.run_length);
  visit("channel.before", s.before);
  visit("channel.entry", s.entry);
  visit("channel.digit", s.digit);
  visit("channel.last", s.last);
  visit("channel.clipped", s.clipped);
}

template <StateOf<RailDetector::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("channels", s.channels);
}

template <StateOf<RailPlane> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("plane.row", s.row);
  visit("plane.distance_rad_s", s.distance_rad_s);
  visit("plane.offset_rad_s", s.offset_rad_s);
  visit("plane.covariance", s.covariance);
  visit("plane.samples", s.samples);
  visit("plane.segments", s.segments);
  visit("plane.deviation_rad_s", s.deviation_rad_s);
  visit("plane.tolerance_rad_s", s.tolerance_rad_s);
  visit("plane.log_odds", s.log_odds);
}

template <StateOf<RailPlanes> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("planes", s.element);
}

template <StateOf<SensingDirections> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("elements.rows", s.rows);
  visit("elements.slope_sigma", s.slope_sigma);
}

template <StateOf<SaturationLevels> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rails.upright_rails", s.axis_aligned_rails);
  visit("rails.planes", s.planes);
  visit("rails.accel_planes", s.accel_planes);
  visit("rails.upright", s.gyro_clips_after_compensation);
  visit("rails.accel_clips_after_compensation", s.accel_clips_after_compensation);
}

template <StateOf<StreamingClippingFinder::Memory> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rails.readings", s.readings);
  visit("rails.peak", s.peak);
  visit("rails.near", s.near);
  visit("rails.unsearched", s.unsearched_near_extremes);
  visit("rails.samples_since_search", s.samples_since_search);
  visit("rails.pruned", s.pruned);
}

template <StateOf<StreamingClippingFinder::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("rails.known", s.known);
  visit("rails.memory", s.memory);
  visit.scratch(s.work);
}

template <StateOf<RailDetector::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit("stated_gyro_rad_s", p.stated_gyro_rad_s);
  visit("stated_accel_m_s2", p.stated_accel_m_s2);
}

template <StateOf<RailPlaneFinder::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit("stated_rad_s", p.stated_rad_s);
  visit("known rails", p.known);
}

}  // namespace tumble
