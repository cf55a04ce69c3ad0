// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_estimate.hpp"
#include "world_covariance.hpp"

/// See mapping.md, heading "Inertial noise".
namespace tumble::mapping {

/// Returns the state before a map exists. Before a map exists, gravity is exactly vertical in the world frame, and a
/// tilt error is an attitude error.
StateEstimate estimate_before_map(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// The map starts only if the standard deviation of the tilt is at most kStartTiltSigmaMax_rad.
inline constexpr double kStartTiltSigmaMax_rad = 0.3;

/// Computes the initial state of an IMU in motion. The direction of the mean specific force of the first 0.5 s
/// determines roll and pitch. The difference between mean specific force and gravity determines the standard deviation
/// of roll and pitch. In flight, the standard deviation of roll and pitch is large enough for all attitudes. `samples`
/// must not be empty.
MotionState start_in_motion(std::span<const MotionSample> samples, double gravity_m_s2);

/// Returns `motion` with the position and heading of `T_WI`, and with unchanged tilt.
MotionState transformed_to_pose(const Eigen::Isometry3d& T_WI, const MotionState& motion);
StateEstimate transformed_to_pose(const Eigen::Isometry3d& T_WI, const StateEstimate& estimate);

/// Replaces roll and pitch by `tilt`, whose errors are independent of all other errors.
StateEstimate with_start_tilt(const LidarInertialOdometry::StartTiltCorrection& tilt, const StateEstimate& estimate);

/// Returns the dead-reckoned state in a new frame with origin and yaw of the current IMU pose. A weak prior on the
/// robot's speed limits the errors of tilt and velocity during minutes of motion. `step_s` is the time since the last
/// call.
StateEstimate reset_origin_and_yaw(const StateEstimate& reckoned, double step_s);

/// Returns the state at the first sweep. The lidar pose of the first sweep defines the map frame, and is therefore
/// exact. In the map frame, the tilt error of dead reckoning becomes an error of gravity's direction.
StateEstimate estimate_at_first_sweep(const LidarInertialOdometry::Params& params, const StateEstimate& reckoned);

/// Returns the covariance of the new map frame relative to the world. The covariance contains the tilt variance of the
/// dead-reckoned state.
WorldCovariance world_at_first_sweep(const LidarInertialOdometry::Params& params, const StateEstimate& reckoned);

}  // namespace tumble::mapping
