// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "state_estimate.hpp"
#include "world_covariance.hpp"

/// before_map.hpp estimates the IMU's state until the first sweep starts the map, see mapping.md, section 6.
namespace tumble::mapping {

/// Returns the state estimate of an IMU whose attitude was levelled by gravity, before a map exists. Gravity is exactly
/// vertical in the world frame, so a wrong tilt is an error of the attitude.
StateEstimate estimate_before_map(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// Increases the covariance of a state that was levelled in motion. In motion, the mean force differs from gravity, and
/// the velocity is unknown.
void widen_for_motion(MotionState& levelled);

/// Returns `motion` with position and heading replaced by those of `T_WI`, and with unchanged tilt.
MotionState moved_to(const Eigen::Isometry3d& T_WI, const MotionState& motion);
StateEstimate moved_to(const Eigen::Isometry3d& T_WI, const StateEstimate& estimate);

/// Returns the estimate with a tilt measured elsewhere, whose errors are independent of all other errors.
StateEstimate with_tilt(const LidarInertialOdometry::StartTilt& tilt, const StateEstimate& estimate);

/// Returns the dead-reckoned state in a frame with origin and yaw of the IMU, `step_s` after the last call. Without a
/// map, measurements do not determine origin and yaw. A weak prior on the speed bounds the errors of tilt and velocity
/// over minutes of motion.
StateEstimate reset_origin_and_yaw(const StateEstimate& reckoned, double step_s);

/// Returns the state at the start of the sweep that starts the map. The lidar's pose at the start of the first sweep
/// defines the map frame and has no error. The tilt error of dead reckoning therefore becomes an error of gravity's
/// direction. `reckoned` is the result of reset_origin_and_yaw() or estimate_before_map().
StateEstimate estimate_at_first_sweep(const LidarInertialOdometry::Params& params, const StateEstimate& reckoned);

/// Returns the map's covariance relative to the world at the start: the vertical is as uncertain as the tilt of
/// `reckoned`.
WorldCovariance world_at_first_sweep(const LidarInertialOdometry::Params& params, const StateEstimate& reckoned);

}  // namespace tumble::mapping
