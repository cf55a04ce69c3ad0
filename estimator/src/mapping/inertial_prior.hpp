// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble::mapping {

/// What the inertial side may be wrong by over one segment, as uncertainty of the state at its start: the registration
/// refines a segment by its start, so noise that arises inside is booked there. A rate error is taken as constant over
/// the segment (it comes from a rail, not from white noise), which makes the attitude's standard deviation the time
/// integral of the rate's. Axes in `deficit_axes` (bits) are left out: they are estimated by themselves.
Eigen::Matrix<double, 9, 9> inertial_noise(const LidarInertialOdometry::Params& params,
                                           const SweepTrajectory& trajectory, std::span<const MotionSample> samples,
                                           unsigned deficit_axes);

/// Variance of the velocity gained over the segment from what the accelerometer's rail hid, in W. One rail's deficit is
/// taken as constant for as long as it lasts.
Eigen::Matrix3d railed_velocity_variance(const LidarInertialOdometry::Params& params, const SweepTrajectory& trajectory,
                                         std::span<const MotionSample> samples);

/// State at rest at the start of the first sample's window: origin of W, levelled by the mean specific force of the
/// samples within `rest_s`, yaw 0. `degenerate` when that force is shorter than 1 m/s^2.
Status start_at_rest(const LidarInertialOdometry::Params& params, std::span<const MotionSample> samples,
                     MotionState& state);
/// The same by that force, without a time.
Status level_at_rest(const LidarInertialOdometry::Params& params, const Eigen::Vector3d& force_I_m_s2,
                     MotionState& state);

/// Uncertainty of a rate method's angular velocity, per IMU axis, as the mapper believes it.
Eigen::Vector3d believed_rate_sigma(const LidarInertialOdometry::Params& params, const RateState& rate);

}  // namespace tumble::mapping
