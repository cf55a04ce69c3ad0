// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/state_params.hpp"
#include "../common/state_variant.hpp"
#include "odometry_impl.hpp"
#include "odometry_members.hpp"
#include "sweep_members.hpp"

/// mapping_members.hpp lists the members of the odometry's state between sweeps, for saving (see state_visitor.hpp).
/// The file README.md in this folder explains the parts of the odometry.
namespace tumble {

namespace mapping {

template <class Self, class Visitor>
void InertialTrack::members(Self& s, Visitor& visit) {
  visit("track.samples", s.samples_);
  visit("track.boundary_ns", s.boundary_ns_);
  visit.scratch(s.rest_detector_);
  visit("track.rest", s.rest_);
  visit("track.initial", s.initial_);
  visit("track.undecided_rad_s", s.pending_rates_rad_s_);
  visit("track.before_newest", s.before_newest_);
  visit("track.newest", s.newest_);
}

template <class Self, class Visitor>
void WindowRate::members(Self& s, Visitor& visit) {
  visit("newest.rate_rad_s", s.rate_rad_s);
  visit("newest.sigma_rad_s", s.sigma_rad_s);
  visit("newest.from_ns", s.from_ns);
  visit("newest.time_ns", s.time_ns);
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
  visit("window.length", s.length_, 1.0, 8.0);
  visit("window.sweeps", s.sweeps_);
}

template <StateOf<DeadReckoning> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("other.boundary", s.boundary);
  visit("other.window", s.window);
  visit("other.world", s.world);
  visit("other.inserted_from", s.inserted_from);
}

template <class Self, class Visitor>
void WorldCovariance::members(Self& s, Visitor& visit) {
  visit_params(s.params_, visit);
  visit("world.start_W_m", s.start_W_m_);
  visit("world.map_at_W_m", s.map_at_W_m_);
  visit("world.start_by_mounting", s.start_mounting_jacobian_);
  visit("world.map", s.map_);
  visit("world.drift_m2", s.drift_covariance_m2_);
}

template <class Self, class Visitor>
void ScanLines::members(Self& s, Visitor& visit) {
  visit("lines.axis_W", s.axis_W_);
  visit("lines.attitude", s.attitude_);
}

template <class Self, class Visitor>
void MapLocaliser::members(Self& s, Visitor& visit) {
  bool has_map = s.has_map();
  visit("prior.has_map", has_map);
  PriorMap map = s.has_map() ? s.map() : PriorMap{};
  visit("prior.points", map.points);
  visit("prior.T_MI", map.T_MI);
  visit("prior.sigma_m", map.sigma_m);
  visit("prior.sigma_rad", map.sigma_rad);
  visit("prior.extend", map.extend);
  visit.scratch(s.scene_);
  if constexpr (Visitor::kReads) {
    if (has_map && visit.going()) visit.refuse(check_prior_map(map));
    if (has_map && visit.going()) s.scene_ = std::make_shared<const PriorScene>(std::move(map));
  }
  visit("prior.localised", s.localised_);
  if constexpr (Visitor::kReads) visit.require("prior.localised", has_map || !s.localised_);
  visit("prior.T_MW", s.T_MW_);
  visit("prior.chance", s.chance_, 0.0, 2.0);
  visit("prior.tried", s.compared_poses_, 1.0, 1e18);
  visit("prior.passed", s.passed_, 0.0, 1e9);
  visit("prior.failed", s.failed_, 0.0, 1e9);
  visit("prior.attempts", s.attempts_, 0.0, 1e9);
  visit("prior.sweeps_since_search", s.sweeps_since_search_, 0.0, 1e9);
}

template <class Self, class Visitor>
void LocalMap::members(Self& s, Visitor& visit) {
  visit("map", s.map_);
  visit("map.seen_from_W_m", s.seen_from_W_m_);
  visit("map.pruned_at_W_m", s.pruned_at_W_m_);
  visit("map.scan_lines", s.scan_lines_);
  visit.scratch(s.levers_W_m_);
  visit.scratch(s.free_space_);
}

}  // namespace mapping

template <class Self, class Visitor>
void LidarInertialOdometry::StartTilt::members(Self& s, Visitor& visit) {
  visit("start_tilt.rotation", s.rotation);
  visit("start_tilt.sigma_rad", s.sigma_rad, 0.0, 10.0);
}

/// Visits all members of the odometry's state except the parameters, which the constructor sets.
template <class Self, class Visitor>
void LidarInertialOdometry::Impl::members(Self& s, Visitor& visit) {
  visit.scratch(s.params);
  visit("start_pose", s.start_pose);
  visit("start_tilt", s.start_tilt);
  visit_variant("tracking", s.tracking, visit);
  visit("track", s.track);
  visit("boundary", s.boundary);
  visit_variant("known", s.known, visit);
  visit("resting_sweeps", s.resting_sweeps, 0.0, 1e9);
  visit("window", s.window);
  visit("local map", s.map);
  visit("world", s.world);
  visit("other", s.other);
  visit("localiser", s.localiser);
  visit.scratch(s.scratch);
}

}  // namespace tumble
