// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/angular_velocity/types.hpp"

namespace tumble {

struct AngularRateKnot {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_rad_s2 = Eigen::Vector3d::Zero();
  bool operator==(const AngularRateKnot&) const = default;
};

/// Residual with three components, and its derivatives with respect to rate, angular acceleration and rig constants.
struct AngularRateFactor {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 6> jacobian_knot;
  Eigen::Matrix<double, 3, BodyImuConstants::kSize> jacobian_calibration;
};

/// Residual of an unsaturated gyro reading: rate + bias - reading [rad/s].
AngularRateFactor gyro_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                              const Eigen::Vector3d& reading_rad_s);

/// Residuals of the three sensing elements of a gyro while an element clips: component of (rate + bias - reading) along
/// the sensing direction [rad/s].
AngularRateFactor sensing_axis_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                      const Eigen::Vector3d& reading_rad_s);

/// Residual of the specific force in free flight [m/s^2]: tangential plus centripetal force at the lever arm, plus
/// bias, minus reading.
AngularRateFactor flight_force_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                      const Eigen::Vector3d& reading_m_s2);

/// Residual of the specific force in free flight [m/s^2], for an accelerometer that is `delay_s` late relative to the
/// gyro. `jacobian_delay` (or null) receives the derivative of the residual with respect to the delay.
AngularRateFactor delayed_flight_force_factor(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                              const Eigen::Vector3d& reading_m_s2, double delay_s,
                                              Eigen::Vector3d* jacobian_delay);

/// Residual of delayed_flight_force_factor() with derivatives only with respect to lever arm and accelerometer bias, at
/// lower cost.
AngularRateFactor delayed_flight_calibration_jacobian(const AngularRateKnot& knot, const BodyImuConstants& rig,
                                                      const Eigen::Vector3d& reading_m_s2, double delay_s);

/// Returns the second time derivative of the specific force at the lever arm in free flight [m/s^4].
Eigen::Vector3d flight_angular_jerk(const AngularRateKnot& knot, const BodyImuConstants& rig);

/// Residual of Euler's equation without torque, with the inertia scaled to trace 3 [rad/s^2].
AngularRateFactor euler_equation_factor(const AngularRateKnot& knot, const BodyImuConstants& rig);

}  // namespace tumble
