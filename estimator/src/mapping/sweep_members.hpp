// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../angular_velocity/rails_members.hpp"
#include "odometry_impl.hpp"
#include "odometry_members.hpp"

/// sweep_members.hpp lists the members of the odometry's sweeps and readings, for saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<MotionSample> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("motion.from_ns", s.from_ns);
  visit("motion.time_ns", s.time_ns);
  visit("motion.w_WI_I_rad_s", s.w_WI_I_rad_s);
  visit("motion.f_I_m_s2", s.f_I_m_s2);
  visit("motion.rate_sigma_rad_s", s.rate_sigma_rad_s);
  visit("motion.clipped_axes", s.clipped_axes);
  visit("motion.accel_saturated_axes", s.accel_saturated_axes);
  visit("motion.at_rest", s.at_rest);
  visit("motion.rest_start_ns", s.rest_start_ns);
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
  visit("unknowns.deficit_rad_s", s.deficit_rad_s);
}

template <StateOf<SweepPoint> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("point.x_I_m", s.x_I_m);
  visit("point.x_L_m", s.point_L_m);
  visit("point.t_s", s.t_s);
  visit("point.sweep_t_s", s.sweep_time_s);
  visit("point.range_m", s.range_m);
  visit("point.ring", s.ring);
}

namespace mapping {

template <StateOf<StateEstimate> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("state_estimate.mean", s.mean);
  visit("state_estimate.weight", s.weight);
  visit("state_estimate.error", s.error);
}

template <StateOf<SweepBoundary> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("boundary.state_estimate", s.state_estimate);
  visit("boundary.end_start_jacobian", s.end_start_jacobian);
  visit("boundary.deficit_share", s.deficit_factor);
  visit("boundary.clipped_velocity_m2_s2", s.clipped_velocity_m2_s2);
  visit("boundary.constrained", s.constrained);
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

template <StateOf<Relocalised> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("relocalised.after_sweeps", s.after_sweeps, 0.0, 1e9);
  visit("relocalised.failed_searches", s.failed_searches, 0.0, 1e9);
  visit("relocalised.agreeing", s.agreeing, 0.0, 1e9);
}

template <StateOf<InertialPrior> Self, class Visitor>
void members(Self&, Visitor&) {}

template <StateOf<ConstantVelocity> Self, class Visitor>
void members(Self&, Visitor&) {}

template <StateOf<KnownVelocity> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("known.v_WI_I_m_s", s.v_WI_I_m_s);
  visit("known.sigma_m_s", s.sigma_m_s);
}

template <StateOf<InsertedPoint> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("inserted.index", s.index);
  visit("inserted.point", s.point);
}

template <StateOf<Estimated> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("estimated.mean", s.mean);
  visit("estimated.errors", s.errors);
}

template <StateOf<WindowSweep> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("sweep.predicted", s.predicted);
  visit("sweep.jacobian_previous", s.jacobian_previous);
  visit("sweep.filtered", s.filtered);
  visit("sweep.smoothed", s.smoothed);
  visit("sweep.samples", s.samples);
  visit("sweep.end_ns", s.end_ns);
  visit("sweep.inserted", s.inserted);
}

}  // namespace mapping

}  // namespace tumble
