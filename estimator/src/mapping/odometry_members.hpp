// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../common/imu_members.hpp"
#include "../common/state_variant.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/prior_map.hpp"
#include "tumble/mapping/detail/sweep_scale.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// odometry_members.hpp lists the members of sweeps and reports, and further members of the mapper's Params, for saving
/// (see state_visitor.hpp).
namespace tumble {

template <StateOf<LidarPoint> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit.with_nan("point.position_L_m", s.position_L_m);  // NaN for a miss
  visit.with_nan("point.intensity", s.intensity);
  visit("point.offset_ns", s.offset_ns);
  visit("point.ring", s.ring);
}

template <StateOf<MapPoint> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("point.position_W_m", s.position_W_m);
  visit("point.normal_W", s.normal_W);
  visit("point.sigma_m", s.sigma_m);
}

template <StateOf<VelocityReading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("velocity.time_ns", s.time_ns);
  visit("velocity.v_WI_I_m_s", s.v_WI_I_m_s);
  visit("velocity.sigma_m_s", s.sigma_m_s);
}

template <StateOf<MotionReading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("motion.from_ns", s.from_ns);
  visit("motion.to_ns", s.to_ns);
  visit("motion.T_from_to", s.T_from_to);
  visit("motion.covariance", s.covariance);
}

template <StateOf<OdometerReading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit_variant("reading", s, visit);
  if constexpr (Visitor::kReads) {
    if (visit.going()) visit.refuse(check_reading(s));
  }
}

template <StateOf<LidarInertialOdometry::SweepReport> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("report.verdict", s.verdict, SweepVerdict::rejected);
  visit("report.pose", s.pose);
  visit("report.velocity_covariance_I_m2_s2", s.velocity_covariance_I_m2_s2);
  visit("report.trajectory", s.trajectory);
  visit("report.smoothed", s.smoothed);
  visit("report.inlier_share", s.inlier_ratio);
  visit("report.conditioning", s.eigenvalue_ratio);
  visit.with_nan("report.weakest_sigma_m", s.least_constrained_sigma_m);  // infinite without constraints
  visit("report.innovation", s.innovation);
  visit("report.map_sigma_m", s.map_sigma_m);
  visit("report.iterations", s.iterations);
  visit("report.lost_sweeps", s.consecutive_rejected_sweeps);
  visit("report.weakest_direction", s.least_constrained_direction);
  visit("report.saturation_deficit_rad_s", s.saturation_deficit_rad_s);
  visit("report.points_used", s.points_used);
  visit("report.lone_points", s.isolated_points);
  visit("report.points_registered", s.points_registered);
  visit("report.map_points_added", s.map_points_added);
  visit("report.in_prior_map", s.in_prior_map);
}

template <StateOf<SweepScale> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("scale.scale", s.scale);
  visit.with_nan("scale.sigma", s.sigma);  // infinite without observations
  visit("scale.changes", s.changes);
}

template <StateOf<SweepScaleEstimator::Change> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("change.time_ns", s.time_ns);
  visit("change.by_imu_m_s", s.imu_change_m_s);
  visit("change.by_sweeps_m_s", s.sweeps_change_m_s);
}

template <class Self, class Visitor>
void SweepScaleEstimator::members(Self& s, Visitor& visit) {
  visit.scratch(s.gravity_m_s2_);
  visit.scratch(s.samples_max_);
  visit("scale.samples", s.samples_);
  visit("scale.sweeps", s.sweeps_);
  visit("scale.changes", s.changes_);
  visit("scale.found", s.scale_);
}

template <class Self, class Visitor>
void Localisation::members(Self& s, Visitor& visit) {
  visit.scratch(s.matched_m_);
  visit("localisation.mapped", s.map_started_);
  visit("localisation.largest_sigma_m", s.largest_sigma_m_);
  visit("localisation.largest_innovation", s.largest_innovation_);
  visit("localisation.second_innovation", s.second_largest_innovation_);
  visit("localisation.sigma_m", s.sigma_m_);
  visit("localisation.newest_ns", s.newest_ns_);
  visit("localisation.lost_since_ns", s.lost_since_ns_);
  visit("localisation.contradicted_ns", s.last_contradicted_ns_);
  visit("localisation.before_ns", s.previous_contradicted_ns_);
}

template <StateOf<FlyingBody> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("body.p_IB_I_m", s.p_IB_I_m);
  visit("body.inertia_I_kg_m2", s.inertia_I_kg_m2);
}

template <StateOf<LidarInertialOdometry::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit("T_IL", p.T_IL);
  visit("body", p.expert.flight.body);
  visit.scratch(p.parallel_for);
}

}  // namespace tumble
