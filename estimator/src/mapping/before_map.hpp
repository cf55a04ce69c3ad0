// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief.hpp"
#include "world_covariance.hpp"

/// The IMU's state before the sweep that starts the map: mapping.md, section 6.
namespace tumble::mapping {

/// Of a levelled IMU. The frame is vertical, so gravity is exact and the tilt is an error of the attitude.
Belief belief_before_map(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// The same state, `step_s` after the last call, with the origin and yaw of the frame moved to the IMU. Without a map
/// neither can be observed. A weak prior on the speed bounds the errors of tilt and velocity over minutes of motion.
Belief without_place(const Belief& reckoned, double step_s);

/// At the start of the sweep that starts the map. The lidar's pose there defines the map's frame and has no error, so
/// the tilt error of dead reckoning becomes an error of gravity's direction. `reckoned` is from without_place() or
/// belief_before_map().
Belief belief_at_first_sweep(const LidarInertialOdometry::Params& params, const Belief& reckoned);

/// World whose vertical is as uncertain as the tilt of `reckoned`.
WorldCovariance world_at_first_sweep(const LidarInertialOdometry::Params& params, const Belief& reckoned);

}  // namespace tumble::mapping
