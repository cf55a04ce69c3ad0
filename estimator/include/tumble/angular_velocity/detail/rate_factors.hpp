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

/// A residual of three rows with its derivatives by (rate, acceleration) and by the constants of the rig.
struct RateFactor {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 6> by_knot;
  Eigen::Matrix<double, 3, RigConstants::kSize> by_rig;
};

/// Gyro while no element clips: rate + bias - reading [rad/s].
RateFactor gyro_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_rad_s);

/// Gyro while an element clips, element by element: m_j . (rate + bias - reading) [rad/s]. Of a free element noise; of
/// the one that clips what its rail hides, whatever the device makes of it on the other axes.
RateFactor element_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_rad_s);

/// Free flight seen by the accelerometer, whose specific force vanishes at the centre of mass [m/s^2]:
/// alpha x t + w x (w x t) + bias - reading.
RateFactor flight_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2);

/// The same for an accelerometer that is `delay_s` late: of the earlier instant to which Euler's equation without
/// torque takes the knot back, w - d alpha + d^2/2 j and alpha - d j with the angular jerk j. Also by inertia.
/// `by_delay` (may be null): the residual's derivative by the delay.
RateFactor late_flight_factor(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2,
                              double delay_s, Eigen::Vector3d* by_delay);

/// The same residual with its derivatives by lever arm and accelerometer's bias alone, all others zero: for who asks
/// how well a sample fits, and moves nothing.
RateFactor late_flight_by_rig(const RateKnot& knot, const RigConstants& rig, const Eigen::Vector3d& reading_m_s2,
                              double delay_s);

/// Second derivative by time of the specific force at the lever arm in free flight [m/s^4]: half of it, times the
/// variance of a window, is what the window adds to the reading.
Eigen::Vector3d flight_curvature(const RateKnot& knot, const RigConstants& rig);

/// Free flight by Euler's equation without torque, with the inertia scaled to trace 3 [rad/s^2]: J alpha + w x J w.
RateFactor euler_factor(const RateKnot& knot, const RigConstants& rig);

}  // namespace tumble
