// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <variant>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Readings of the robot's odometer about the motion within a sweep, from wheels, legs, a camera or a radar. A reading
/// is fused with the prediction from the IMU and earlier sweeps by the covariances of reading and prediction. The
/// registration starts from the fused prediction. Times are in the IMU's clock. The errors of a reading are assumed
/// independent of all other errors. Wheel slip beyond the stated uncertainty therefore corrupts the estimate.

/// Velocity of the IMU at one time.
struct VelocityReading {
  TimeNs time_ns = 0;
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();  ///< velocity in IMU axes at the reading's time
  double sigma_m_s = 0.0;                                ///< standard deviation of each axis
};

/// Motion of the IMU between two times, also known as the initial guess of a registration. For poses in a drifting
/// frame O, the motion is T_OI(from)^-1 T_OI(to).
struct MotionReading {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  /// Covariance of (position error [m], attitude error phi [rad]), both in IMU axes at `from_ns`: R_true = Exp(phi) R.
  /// Set a large variance for components that the odometer does not measure.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

using OdometerReading = std::variant<VelocityReading, MotionReading>;

/// Checks a single reading. `non_finite`: a number is not finite. `out_of_range`: a standard deviation is not above 0,
/// a covariance is not positive definite, or a rotation is invalid. `time_order`: a motion does not end after its
/// start.
Status check_reading(const OdometerReading& reading);
/// Return the start and the end of a reading. The start and the end of a velocity reading are equal.
TimeNs begins_ns(const OdometerReading& reading);
TimeNs ends_ns(const OdometerReading& reading);

}  // namespace tumble
