// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "odometry_impl.hpp"
#include "tumble/angular_velocity/rails_members.hpp"
#include "tumble/mapping/odometry_members.hpp"

/// Members of what persists from sweep to sweep: state_visitor.hpp, README.md.
namespace tumble {

template <StateOf<MotionSample> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("motion.from_ns", s.from_ns);
  visit("motion.time_ns", s.time_ns);
  visit("motion.w_WI_I_rad_s", s.w_WI_I_rad_s);
  visit("motion.f_I_m_s2", s.f_I_m_s2);
  visit("motion.rate_sigma_rad_s", s.rate_sigma_rad_s);
  visit("motion.clipped_axes", s.clipped_axes);
  visit("motion.railed_axes", s.railed_axes);
  visit("motion.at_rest", s.at_rest);
  visit("motion.rests_since_ns", s.rests_since_ns);
  visit("motion.in_flight", s.in_flight);
  visit("motion.bridges_gap", s.bridges_gap);
}

template <StateOf<MotionState> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("state.time_ns", s.time_ns);
  visit("state.p_WI_m", s.p_WI_m);
  visit("state.q_WI", s.q_WI);
  visit("state.v_WI_m_s", s.v_WI_m_s);
  visit("state.covariance", s.covariance);
}

template <StateOf<SweepCalibration> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("calibration.T_IL", s.T_IL);
  visit("calibration.time_offset_s", s.time_offset_s);
  visit("calibration.gravity_W_m_s2", s.gravity_W_m_s2);
}

template <StateOf<Registration::Estimate> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("unknowns.state", s.state);
  visit("unknowns.calibration", s.calibration);
  visit("unknowns.excess_rad_s", s.excess_rad_s);
}

template <StateOf<SweepPoint> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("point.x_I_m", s.x_I_m);
  visit("point.x_L_m", s.x_L_m);
  visit("point.t_s", s.t_s);
  visit("point.sweep_t_s", s.sweep_t_s);
  visit("point.range_m", s.range_m);
  visit("point.ring", s.ring);
}

namespace mapping {

template <StateOf<Belief> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("belief.mean", s.mean);
  visit("belief.weight", s.weight);
  visit("belief.error", s.error);
}

template <StateOf<Border> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("border.belief", s.belief);
  visit("border.end_by_start", s.end_by_start);
  visit("border.excess_share", s.excess_share);
  visit("border.railed_velocity_m2_s2", s.railed_velocity_m2_s2);
  visit("border.held", s.held);
}

template <StateOf<WaitingForStart> Self, class Visitor>
void members(Self&, Visitor&) {}

template <StateOf<Tracking> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("tracking.failed_searches", s.failed_searches, 0.0, 1e9);
}

template <StateOf<Lost> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("lost.sweeps", s.sweeps, 0.0, 1e9);
  visit("lost.failed_searches", s.failed_searches, 0.0, 1e9);
}

template <StateOf<FoundAgain> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("found_again.after_sweeps", s.after_sweeps, 0.0, 1e9);
}

template <StateOf<InertialPrior> Self, class Visitor>
void members(Self&, Visitor&) {}

template <StateOf<KnownVelocity> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("known.v_WI_I_m_s", s.v_WI_I_m_s);
  visit("known.sigma_m_s", s.sigma_m_s);
}

template <StateOf<DrawnPoint> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("drawn.index", s.index);
  visit("drawn.point", s.point);
}

template <StateOf<Estimated> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("estimated.mean", s.mean);
  visit("estimated.errors", s.errors);
}

template <StateOf<WindowSweep> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sweep.predicted", s.predicted);
  visit("sweep.by_before", s.by_before);
  visit("sweep.filtered", s.filtered);
  visit("sweep.smoothed", s.smoothed);
  visit("sweep.samples", s.samples);
  visit("sweep.end_ns", s.end_ns);
  visit("sweep.drawn", s.drawn);
}

template <class Self, class Visitor>
void InertialTrack::members(Self& s, Visitor& visit) {
  visit("track.samples", s.samples_);
  visit("track.border_ns", s.border_ns_);
  visit.scratch(s.rests_);
  visit("track.rest", s.rest_);
  visit("track.initial", s.initial_);
  visit("track.undecided_rad_s", s.undecided_rad_s_);
  visit("track.before_newest", s.before_newest_);
  visit("track.newest", s.newest_);
}

template <class Self, class Visitor>
void InertialTrack::Rate::members(Self& s, Visitor& visit) {
  visit("newest.rate_rad_s", s.rate_rad_s);
  visit("newest.middle_ns", s.middle_ns);
}

template <class Self, class Visitor>
void InertialTrack::InitialRest::members(Self& s, Visitor& visit) {
  visit("initial.lasts", s.lasts);
  visit("initial.first_ns", s.first_ns);
  visit("initial.run_ns", s.run_ns);
  visit("initial.gyro_bias_rad_s", s.gyro_bias_rad_s);
}

template <class Self, class Visitor>
void LagWindow::members(Self& s, Visitor& visit) {
  visit.scratch(s.length_);  // of the parameters
  visit("window.sweeps", s.sweeps_);
}

template <class Self, class Visitor>
void WorldCovariance::members(Self& s, Visitor& visit) {
  visit_params(s.params_, visit);
  visit("world.start_by_mounting", s.start_by_mounting_);
  visit("world.map", s.map_);
  visit("world.drift_m2", s.drift_m2_);
}

template <class Self, class Visitor>
void ScanLines::members(Self& s, Visitor& visit) {
  visit("lines.axis_W", s.axis_W_);
  visit("lines.attitude", s.attitude_);
}

template <class Self, class Visitor>
void LocalMap::members(Self& s, Visitor& visit) {
  visit("map", s.map_);
  visit("map.seen_from_W_m", s.seen_from_W_m_);
  visit("map.pruned_at_W_m", s.pruned_at_W_m_);
  visit("map.scan_lines", s.scan_lines_);
  visit.scratch(s.levers_W_m_);
}

}  // namespace mapping

/// One of several kinds: which, and its members.
template <class Variant, class Visitor, std::size_t... Kinds>
void visit_variant(const char* name, Variant& value, Visitor& visit, std::index_sequence<Kinds...>) {
  using V = std::remove_const_t<Variant>;
  std::size_t kind = value.index();
  visit(name, kind, 0.0, double(sizeof...(Kinds) - 1));
  const auto one = [&]<std::size_t Kind>(std::integral_constant<std::size_t, Kind>) {
    if constexpr (Visitor::kDescribes) {
      const std::variant_alternative_t<Kind, V> as_at_the_start{};
      visit(name, as_at_the_start);
    } else if (kind == Kind) {
      if constexpr (Visitor::kReads) value.template emplace<Kind>();
      visit(name, *std::get_if<Kind>(&value));
    }
  };
  (one(std::integral_constant<std::size_t, Kinds>{}), ...);
}
template <class Variant, class Visitor>
void visit_variant(const char* name, Variant& value, Visitor& visit) {
  visit_variant(name, value, visit, std::make_index_sequence<std::variant_size_v<std::remove_const_t<Variant>>>());
}

/// But for the parameters, which are those that it is made with.
template <class Self, class Visitor>
void LidarInertialOdometry::Impl::members(Self& s, Visitor& visit) {
  visit.scratch(s.params);
  visit_variant("tracking", s.tracking, visit);
  visit("track", s.track);
  visit("border", s.border);
  visit_variant("known", s.known, visit);
  visit("resting_sweeps", s.resting_sweeps, 0.0, 1e9);
  visit("window", s.window);
  visit("local map", s.map);
  visit("world", s.world);
  visit.scratch(s.points);
  visit.scratch(s.aligner);
  visit.scratch(s.trajectory);
}

}  // namespace tumble
