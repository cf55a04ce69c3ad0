// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble {

/// Constants of a body that determine its free flight.
struct FlyingBody {
  Eigen::Vector3d p_IB_I_m = Eigen::Vector3d::Zero();             ///< centre of mass in IMU axes
  Eigen::Matrix3d inertia_I_kg_m2 = Eigen::Matrix3d::Identity();  ///< about the centre of mass; only its shape matters
};

/// Returns the angular acceleration of a torque-free body: I^-1 (I w x w), IMU axes.
Eigen::Vector3d torque_free_acceleration(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s);

/// Returns the reading of an accelerometer off the centre of mass while only gravity acts on the body. The reading is
/// -(a x r + w x (w x r)), with r from the IMU to the centre of mass, the rate w and the angular acceleration a.
Eigen::Vector3d flight_force(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s,
                             const Eigen::Vector3d& angular_acceleration_I_rad_s2);

/// Predicts the motion over a segment of flight without readings, as a ballistic arc. Appends samples over (from_ns,
/// to_ns], each at most step_ns long. When SweepTrajectory integrates the samples, the centre of mass moves along a
/// parabola and the body rotates free of torque, starting from the initial rate. On error `samples` is unchanged:
/// `time_order` (empty time interval or no step), `non_finite`, `degenerate` (invalid inertia). Euler's equation is
/// integrated by a Runge-Kutta method of fourth order. The rotation over a step is exact to third order of the step.
/// Drag is not modelled.
Status flight_arc(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s, TimeNs from_ns, TimeNs to_ns,
                  TimeNs step_ns, std::vector<MotionSample>& samples);

}  // namespace tumble
