// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <variant>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// What an odometer of the robot's tells of the motion within a sweep: wheels, legs, a camera, a radar. It is weighed
/// against what the IMU and the sweeps before tell, by the covariances of both, and the surfaces are registered from
/// there. Times are the IMU's clock. Its errors are taken as independent of all else: a wheel that slips longer than it
/// says is an odometer that is wrong.

/// Velocity of the IMU at one instant.
struct VelocityReading {
  TimeNs time_ns = 0;
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();  ///< in IMU axes at that time
  double sigma_m_s = 0.0;                                ///< standard deviation of each axis
};

/// Motion of the IMU from one instant to a later one: what others call the initial guess of a registration. Of poses in
/// a frame O that drifts: T_OI(from)^-1 T_OI(to).
struct MotionReading {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  /// Of (position error [m], attitude error phi [rad]), both in IMU axes at `from_ns`: R_true = Exp(phi) R. What the
  /// odometer does not tell has a variance that is large.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

using OdometerReading = std::variant<VelocityReading, MotionReading>;

/// Of a reading by itself: `non_finite`; `out_of_range` where a standard deviation is not above 0, a covariance is not
/// positive definite, or what should be a rotation is none; `time_order` where a motion does not end after its
/// beginning.
Status check_reading(const OdometerReading& reading);
/// When it begins and ends: for a velocity the same.
TimeNs begins_ns(const OdometerReading& reading);
TimeNs ends_ns(const OdometerReading& reading);

}  // namespace tumble
