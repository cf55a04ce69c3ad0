// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <stdexcept>

#include "sim/built_situation.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// SimulationFailure is thrown for a simulated run that is rejected:
/// - a warning of MuJoCo, or a state that is not finite;
/// - a speed above 5 mm/s after the second of settling before the start;
/// - a position beyond the half extent of the world, or 60 m below the world's origin;
/// - a robot that never moves 5 cm away from the start;
/// - a sensor more than 1 cm below a height field for longer than 0.05 s (sim/truth/above_ground.hpp).
class SimulationFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Simulates one situation: rigid bodies and contact (MuJoCo, RK4, 0.5 ms), IMU readings, lidar sweeps, truth. The
/// recording is independent of `threads`, the number of threads for the lidar. Throws InvalidSituation if the robot
/// lacks a sensor's site, or if the motion is impossible in the world. Throws SimulationFailure for a rejected run.
Recording simulate(const BuiltSituation& built, int threads = 1);

/// Returns the initial pose of the robot's body frame, before the body settles into its contacts. Throws
/// InvalidSituation if the motion is impossible in the situation's world.
Eigen::Isometry3d start_pose(const BuiltSituation& built);

}  // namespace tumble::sim
