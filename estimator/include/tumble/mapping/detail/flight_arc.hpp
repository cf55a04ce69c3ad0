// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"

namespace tumble {

struct FlyingBody {
  Eigen::Vector3d p_IB_I_m = Eigen::Vector3d::Zero();             ///< centre of mass in IMU axes
  Eigen::Matrix3d inertia_I_kg_m2 = Eigen::Matrix3d::Identity();  ///< inertia about the centre of mass, in any unit
};

/// Returns the angular acceleration of a torque-free body, in IMU axes.
Eigen::Vector3d torque_free_acceleration(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s);

/// Returns the specific force at the IMU in free flight: tangential plus centripetal force at the lever arm.
Eigen::Vector3d flight_force(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s,
                             const Eigen::Vector3d& angular_acceleration_I_rad_s2);

/// Predicts the motion over a segment of flight without IMU readings: a parabola of the centre of mass and a rotation
/// without torque. Appends samples over (from_ns, to_ns] to `samples`, each at most `step_ns` long. Returns
/// `time_order` (empty time interval or no step), `non_finite`, or `degenerate` (invalid inertia). On error, `samples`
/// is unchanged. A Runge-Kutta method of fourth order integrates Euler's equation. Drag is neglected.
Status flight_arc(const FlyingBody& body, const Eigen::Vector3d& w_WI_I_rad_s, TimeNs from_ns, TimeNs to_ns,
                  TimeNs step_ns, std::vector<MotionSample>& samples);

}  // namespace tumble
