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
  Eigen::Matrix<double, 3, RigConstants::kSize> by_rig;
};

/// Residual of the gyro while no element clips: rate + bias - reading [rad/s].
RateFactor gyro_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_rad_s);

/// Residual of the gyro while an element clips, per element: m_j . (rate + bias - reading) [rad/s]. For a free element
/// it is noise. For the clipped element it is the saturation deficit, independent of the device's cross-axis
/// compensation.
RateFactor element_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_rad_s);

/// Residual of the accelerometer in free flight [m/s^2]: alpha x t + w x (w x t) + bias - reading. The specific force
/// at the centre of mass is zero.
RateFactor flight_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2);

/// Same for an accelerometer that is `delay_s` late. Euler's equation without torque propagates the knot back to the
/// earlier time. The result is w - d alpha + d^2/2 j and alpha - d j, with the angular jerk j. The residual also
/// depends on the inertia. `by_delay` (may be null) receives the derivative by the delay.
RateFactor late_flight_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2,
                              double delay_s, Eigen::Vector3d* by_delay);

/// Same residual with derivatives by lever arm and accelerometer bias only; all others are zero. For callers that only
/// evaluate how well a sample fits.
RateFactor late_flight_by_rig(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2,
                              double delay_s);

/// Returns the second time derivative of the specific force at the lever arm in free flight [m/s^4]. Half of it, times
/// the variance of a window, is the window's effect on a reading.
Eigen::Vector3d flight_curvature(const RateKnot& knot, const RigConstants& rig);

/// Residual of Euler's equation without torque, with the inertia scaled to trace 3 [rad/s^2]: J alpha + w x J w.
RateFactor euler_factor(const RateKnot& knot, const RigConstants& rig);

}  // namespace tumble
