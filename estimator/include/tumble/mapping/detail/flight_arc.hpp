// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"

namespace tumble {

/// FlyingBody contains the centre of mass and the inertia of a body, which determine its free flight.
struct FlyingBody {
  Eigen::Vector3d p_IB_I_m = Eigen::Vector3d::Zero();             ///< centre of mass in IMU axes
  Eigen::Matrix3d inertia_I_kg_m2 = Eigen::Matrix3d::Identity();  ///< inertia about the centre of mass, in any unit
};

/// Returns the angular acceleration of a torque-free body, I^-1 (I w x w), in IMU axes.
Eigen::Vector3d torque_free_acceleration(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s);

/// Returns the reading of the IMU's accelerometer in free flight, in which only gravity acts on the body. The reading
/// is -(a x r + w x (w x r)), with r from the IMU to the centre of mass, rate w and angular acceleration a.
Eigen::Vector3d flight_force(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s,
                             const Eigen::Vector3d& angular_acceleration_I_rad_s2);

/// Predicts the motion over a segment of flight without IMU readings, as a ballistic arc. The function appends samples
/// over (from_ns, to_ns] to `samples`, each at most `step_ns` long. If SweepTrajectory integrates the samples, the
/// centre of mass moves along a parabola. The body rotates without torque, starting from the initial rate. Returns
/// `time_order` (empty time interval or no step), `non_finite`, or `degenerate` (invalid inertia). On error, `samples`
/// is unchanged. A Runge-Kutta method of fourth order integrates Euler's equation. The rotation over a step is exact to
/// third order of the step. The function neglects drag.
Status flight_arc(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s, TimeNs from_ns, TimeNs to_ns,
                  TimeNs step_ns, std::vector<MotionSample>& samples);

}  // namespace tumble
