// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble {

/// What has to be known of a body to tell its free flight.
struct FlyingBody {
  Eigen::Vector3d p_IB_I_m = Eigen::Vector3d::Zero();             ///< centre of mass in IMU axes
  Eigen::Matrix3d inertia_I_kg_m2 = Eigen::Matrix3d::Identity();  ///< about the centre of mass; only its shape counts
};

/// Angular acceleration of a body that no torque acts on: I^-1 (I w x w), IMU axes.
Eigen::Vector3d torque_free_acceleration(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s);

/// What an accelerometer off the centre of mass reads while nothing but gravity acts on the body:
/// -(a x r + w x (w x r)) with r from the IMU to the centre of mass and the angular acceleration a.
Eigen::Vector3d flight_force(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s,
                             const Eigen::Vector3d& angular_acceleration_I_rad_s2);

/// The ballistic arc as a source of motion, for a segment of flight that no reading covers: samples over
/// (from_ns, to_ns], at most step_ns long, whose integration (SweepTrajectory) takes the centre of mass along a
/// parabola and turns the body free of torque, from the rate at the start. Trouble: `time_order` (nothing between the
/// two times, or no step), `non_finite`, `degenerate` (an inertia that is none); then `samples` is as it was, else the
/// new ones are appended. Euler's equation by Runge-Kutta of fourth order; the rotation over a step is exact to the
/// third order of the step. Not modelled: drag.
Status flight_arc(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s, TimeNs from_ns, TimeNs to_ns,
                  TimeNs step_ns, std::vector<MotionSample>& samples);

}  // namespace tumble
