// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/rig_constants.hpp"

namespace tumble {

/// Unknowns at one sample: rate and angular acceleration of the body, IMU axes.
struct RateKnot {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_rad_s2 = Eigen::Vector3d::Zero();
  bool operator==(const RateKnot&) const = default;
};

/// Residual of three rows with its derivatives by (rate, acceleration) and by the calibration constants.
struct RateFactor {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 6> by_knot;
  Eigen::Matrix<double, 3, RigConstants::kSize> jacobian_calibration;
};

/// Residual of the gyro while no element clips: rate + bias - reading [rad/s].
RateFactor gyro_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_rad_s);

/// Residual of the gyro while an element clips, per element: m_j . (rate + bias - reading) [rad/s]. For an unsaturated
/// element the residual is noise. For the clipped element the residual is the saturation deficit, independent of the
/// device's cross-axis compensation.
RateFactor element_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_rad_s);

/// Residual of the accelerometer in free flight [m/s^2]: alpha x t + w x (w x t) + bias - reading. Here w is the rate,
/// alpha the angular acceleration and t the lever arm. The specific force at the centre of mass is zero.
RateFactor flight_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2);

/// Residual of an accelerometer in free flight that is `delay_s` late [m/s^2]. Euler's equation without torque
/// propagates the knot back by the delay d. The propagated rate is w - d alpha + d^2/2 j and the propagated
/// acceleration alpha - d j, with the angular jerk j. The residual also depends on the inertia. `by_delay` (may be
/// null) receives the derivative by the delay.
RateFactor late_flight_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2,
                              double delay_s, Eigen::Vector3d* by_delay);

/// Residual of late_flight_factor() with derivatives by lever arm and accelerometer bias only; all other derivatives
/// are zero. The function is for callers that only evaluate how well a sample fits.
RateFactor late_flight_by_rig(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2,
                              double delay_s);

/// Returns the second time derivative of the specific force at the lever arm in free flight [m/s^4]. Half of the second
/// derivative, times the variance of a window, is the window's effect on a reading.
Eigen::Vector3d flight_curvature(const RateKnot& knot, const RigConstants& rig);

/// Residual of Euler's equation without torque, with the inertia scaled to trace 3 [rad/s^2]: J alpha + w x J w.
RateFactor euler_factor(const RateKnot& knot, const RigConstants& rig);

}  // namespace tumble
