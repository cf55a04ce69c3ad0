// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <variant>

#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Odometer readings describe the motion of the robot within a sweep, measured by wheels, legs, a camera or a radar.
/// Times of odometer readings are in the IMU's clock. The errors of an odometer reading are assumed independent of all
/// other errors. Wheel slip beyond the stated uncertainty corrupts the estimate.

struct VelocityReading {
  TimeNs time_ns = 0;
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();  ///< velocity in IMU axes at the reading's time
  double sigma_m_s = 0.0;                                ///< standard deviation of each axis
};

/// Motion of the IMU I between two times. For IMU poses T_OI in a drifting odometer frame O, the motion is
/// T_OI(from)^-1 T_OI(to).
struct MotionReading {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
  Eigen::Isometry3d relative_pose = Eigen::Isometry3d::Identity();
  /// Covariance of the position error [m] and the attitude error phi [rad], both in IMU axes at `from_ns`, with R_true
  /// = Exp(phi) R. Set a large variance for components that the odometer does not measure.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

using OdometerReading = std::variant<VelocityReading, MotionReading>;

/// Returns `non_finite` if a number is not finite. Returns `out_of_range` if a standard deviation is not above 0, a
/// covariance is not positive definite, or a rotation is invalid. Returns `time_order` if a motion does not end after
/// its start.
Status check_reading(const OdometerReading& reading);
TimeNs reading_start_ns(const OdometerReading& reading);
TimeNs reading_end_ns(const OdometerReading& reading);

/// PositionReading is the position of an antenna or tag A on the robot, in a position frame P with z up, for example
/// from GPS (as local east, north, up) or from beacons. PositionAlignment assumes that the errors of the readings are
/// independent. If the errors are correlated over time, state a larger covariance.
struct PositionReading {
  TimeNs time_ns = 0;  ///< in the IMU's clock
  Eigen::Vector3d antenna_position_P_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< in the frame P; the mean variance of the axes is used
  Eigen::Vector3d antenna_lever_arm_I_m = Eigen::Vector3d::Zero();  ///< position of the antenna or tag A in IMU axes
};

/// PositionFrame is the estimated transform from the odometry frame W of the poses to the position frame P of the
/// position readings. The transform includes the drift of the odometry, so poses in the position frame do not drift.
struct PositionFrame {
  Eigen::Isometry3d T_readings_world = Eigen::Isometry3d::Identity();  ///< the rotation is about the vertical
  Eigen::Vector3d reference_point_W_m = Eigen::Vector3d::Zero();
  /// Covariance of the error of T_PW, in axes of the position frame P: translation at `reference_point_W_m` [m], and
  /// rotation about the vertical through this point [rad].
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();

  /// Converts a pose from the odometry frame W to the position frame P. The covariance of position and heading comes
  /// from `covariance`, and the covariance of the tilt from `in_W`.
  PoseState transform(const PoseState& in_W) const;
};

}  // namespace tumble
