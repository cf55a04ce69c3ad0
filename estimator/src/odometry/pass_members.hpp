// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>
#include <vector>

#include "../attitude/regime_stream_members.hpp"
#include "../attitude/rest_gravity_members.hpp"
#include "../mapping/odometry_members.hpp"
#include "tumble/angular_velocity/detail/gyro_offset.hpp"
#include "tumble/odometry/detail/odometry_pass.hpp"
#include "tumble/odometry/detail/second_pass.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"

/// pass_members.hpp lists the members of the two passes of TumblingOdometry, for saving (see state_visitor.hpp).
namespace tumble {

namespace odometry {

template <class Visitor>
void check_offset(const RegimeStream::Params& rate, Visitor& visit) {
  visit.bounded("gyro offset", rate.rate.model.nominal.gyro_bias_rad_s.cwiseAbs().maxCoeff(), 0.0,
                GyroOffset::kOffsetMax_rad_s);
}

/// Visits those parameters of the rate estimation that may come from an earlier run.
template <StateOf<RegimeStream::Params> Self, class Visitor>
void visit_estimated(Self& p, Visitor& visit) {
  visit("gyro offset", p.rate.model.nominal.gyro_bias_rad_s);
  visit("calibration", p.rate.model.calibration);
  visit("known rails", p.rate.expert.planes.known);
  visit("known saturation limits of the accelerometer", p.rate.expert.accel_planes.known);
}

}  // namespace odometry

/// Visits the samples of a queue that are still in use.
template <class Self, class Visitor>
void OdometryPass::Queue::members(Self& s, Visitor& visit) {
  if constexpr (std::is_const_v<Self>) {
    const std::vector<ImuSample> waiting(s.all().begin(), s.all().end());
    visit("queue.samples", waiting);
  } else {
    visit("queue.samples", s.samples);
    s.head = 0;
  }
  visit.scratch(s.samples);
  visit.scratch(s.head);
}

template <class Self, class Visitor>
void OdometryPass::members(Self& s, Visitor& visit) {
  RegimeStream::Params rate = s.rates_.params();
  odometry::visit_estimated(rate, visit);
  visit.scratch(s.rates_);
  if constexpr (!std::is_const_v<Self>) {
    odometry::check_offset(rate, visit);
    if (visit.going() && rate.rate.model.calibration) visit.refuse(check_calibration(*rate.rate.model.calibration));
    if (!visit.going()) return;
    s.start_rate_estimation(rate);
  }
  visit("pass.rates", s.rate_state_);
  visit("pass.mapper", s.mapper_);
  visit("pass.scale", s.scale_);
  visit("pass.localisation", s.localisation_);
  visit.scratch(s.rate_sigma_max_rad_s_);
  visit("pass.time_offset_s", s.time_offset_s_, -1.0, 1.0);  // same bounds as the mapper's parameter
  visit("pass.pending", s.pending_);
  visit("pass.smoothed", s.smoothed_);
  visit("pass.last_mapped_ns", s.last_mapped_ns_);
  visit("pass.rejected_samples", s.rejected_samples_);
  visit.scratch(s.rest_gravity_);  // derived from the parameters
  visit("pass.gravity", s.rest_gravity_state_);
}

template <class Self, class Visitor>
void WaitingReadings::members(Self& s, Visitor& visit) {
  visit("readings.waiting", s.waiting_);
  if constexpr (Visitor::kReads)
    visit.bounded("readings.waiting", double(s.waiting_.size()), 0.0, double(kReadingsMax));
  visit("readings.straddling", s.spanning_two_sweeps_);
}

template <class Self, class Visitor>
void SecondPass::Sweep::members(Self& s, Visitor& visit) {
  visit("remembered.start_ns", s.start_ns);
  visit("remembered.end_ns", s.end_ns);
  visit("remembered.points", s.points);
  visit("remembered.reading", s.reading);
  visit("remembered.verdict", s.verdict, SweepVerdict::rejected);
}

template <class Self, class Visitor>
void SecondPass::members(Self& s, Visitor& visit) {
  visit.scratch(s.params_);
  visit("second_pass.gyro_offset", s.rate_.rate.model.nominal.gyro_bias_rad_s);
  if constexpr (Visitor::kReads) odometry::check_offset(s.rate_, visit);
  visit.scratch(s.rate_);
  visit.scratch(s.mapping_);
  visit("second_pass.wanted", s.enabled_);
  visit("second_pass.taken", s.applied_);
  visit.scratch(s.rest_detector_);
  visit("second_pass.rest", s.rest_);
  visit("second_pass.moves_ns", s.motion_start_ns_);
  visit("second_pass.samples", s.samples_);
  visit("second_pass.sweeps", s.sweeps_);
  bool is_running = s.pass_.has_value();
  visit("second_pass.under_way", is_running);
  if constexpr (!std::is_const_v<Self>) {
    s.pass_.reset();
    if (is_running && visit.going()) s.pass_.emplace(s.delayed_rate_params(), s.mapping_);
  }
  // StateLayout already contains the members of an OdometryPass, so the second one is omitted
  if (s.pass_ && !Visitor::kDescribes) visit("second_pass.pass", *s.pass_);
  visit.scratch(s.pass_);
  visit("second_pass.next_sample", s.next_sample_, 0.0, double(s.samples_.all().size()));
  visit("second_pass.next_sweep", s.next_sweep_, 0.0, double(s.sweeps_.size()));
  visit("second_pass.rejected_by_first", s.rejected_by_first_);
  visit("second_pass.rejected", s.rejected_);
  visit("second_pass.lost", s.last_sweep_rejected_);
  visit("second_pass.early", s.started_by_tracking_failure_);
  visit("second_pass.tried", s.early_pass_tried_);
}

}  // namespace tumble
