// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// Returns the covariance that inertial integration over one sweep adds to the errors of position, attitude and
/// velocity. Rate errors come mainly from saturation, so rate errors are assumed constant over the sweep. Clipped axes
/// in the bit mask `deficit_axes` add no noise, because the registration estimates the saturation deficit of these
/// axes.
Eigen::Matrix<double, 9, 9> inertial_noise(const LidarInertialOdometry::Params& params,
                                           const SweepTrajectory& trajectory, std::span<const MotionSample> samples,
                                           unsigned deficit_axes);

/// Returns the covariance, in frame W, of the velocity change over a sweep due to accelerometer saturation. The
/// saturation deficit of the specific force is assumed constant while the saturation lasts.
Eigen::Matrix3d velocity_variance_from_clipping(const SweepTrajectory& trajectory,
                                                std::span<const MotionSample> samples);

/// Computes the state of an IMU at rest, at the origin of W with yaw 0, at the start of the first averaging window. The
/// mean specific force of the first 0.5 s levels the attitude. Returns `degenerate` if the mean specific force is below
/// 1 m/s^2.
Status start_at_rest(std::span<const MotionSample> samples, MotionState& state);
Status level_at_rest(const Eigen::Vector3d& force_I_m_s2, MotionState& state);

/// Returns the standard deviation of the rate, at most kRateSigmaMax_rad_s of InertialNoiseParams.
Eigen::Vector3d assumed_rate_sigma(const LidarInertialOdometry::Params& params, const AngularRateState& rate);

}  // namespace tumble::mapping
