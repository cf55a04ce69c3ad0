// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble::mapping {

/// Returns the errors of inertial integration over one segment as uncertainty of the state at the start of the segment.
/// A rate error is assumed constant over the segment, because the error comes from saturation, not from white noise.
/// The standard deviation of the attitude is therefore the time integral of the rate's standard deviation. Axes in
/// `deficit_axes` (bits) are excluded, because the registration estimates the saturation deficit of the axes
/// separately.
Eigen::Matrix<double, 9, 9> inertial_noise(const LidarInertialOdometry::Params& params,
                                           const SweepTrajectory& trajectory, std::span<const MotionSample> samples,
                                           unsigned deficit_axes);

/// Returns the variance of the velocity change over the segment due to accelerometer saturation, in W. The saturation
/// deficit of the force is assumed constant while a saturation lasts.
Eigen::Matrix3d clipped_velocity_variance(const LidarInertialOdometry::Params& params,
                                          const SweepTrajectory& trajectory, std::span<const MotionSample> samples);

/// Computes the state at rest at the start of the first sample's window, with origin of W and yaw 0. The mean specific
/// force of the samples within `rest_s` levels the attitude. Returns `degenerate` if the mean force is below 1 m/s^2.
Status start_at_rest(const LidarInertialOdometry::Params& params, std::span<const MotionSample> samples,
                     MotionState& state);
/// Computes the state at rest, levelled by a specific force, without a time.
Status level_at_rest(const LidarInertialOdometry::Params& params, const Eigen::Vector3d& force_I_m_s2,
                     MotionState& state);

/// Returns the standard deviation of the angular velocity of a rate method, per IMU axis, limited to the mapper's upper
/// bound.
Eigen::Vector3d assumed_rate_sigma(const LidarInertialOdometry::Params& params, const RateState& rate);

}  // namespace tumble::mapping
