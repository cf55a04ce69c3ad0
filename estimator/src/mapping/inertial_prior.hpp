// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// Returns the covariance that inertial integration over one sweep adds to the errors of position, attitude and
/// velocity. Angular rate errors are mostly due to saturation, and therefore assumed constant over the sweep. The
/// registration estimates the saturation deficits of the clipped gyro axes in the bit mask `deficit_axes`, so these
/// axes add no noise.
Eigen::Matrix<double, 9, 9> inertial_noise(const LidarInertialOdometry::Params& params,
                                           const SweepTrajectory& trajectory, std::span<const MotionSample> samples,
                                           unsigned deficit_axes);

/// Returns the covariance, in world axes, of the velocity change over a sweep due to accelerometer saturation. The
/// error of a saturated accelerometer axis is assumed constant during the saturation.
Eigen::Matrix3d velocity_variance_from_clipping(const SweepTrajectory& trajectory,
                                                std::span<const MotionSample> samples);

/// Computes the initial state of an IMU at rest, at the origin of the world frame with yaw 0. The mean specific force
/// of the first 0.5 s determines roll and pitch. Returns `degenerate` if the mean specific force is below 1 m/s^2.
Status start_at_rest(std::span<const MotionSample> samples, MotionState& state);
Status level_at_rest(const Eigen::Vector3d& force_I_m_s2, MotionState& state);

/// Returns the standard deviation of the angular rate per axis. For clipped gyro axes without a recovered rate, the
/// standard deviation is increased.
Eigen::Vector3d assumed_rate_sigma(const LidarInertialOdometry::Params& params, const AngularRateState& rate);

}  // namespace tumble::mapping
