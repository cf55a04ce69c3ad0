// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <stdexcept>

#include "sim/built_situation.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

/// Thrown when a draw is rejected, by these rules: a warning of the engine; a state that is not finite; faster than 5
/// mm/s after the second of settling before the start; beyond the half extent of its world or 60 m below its origin;
/// never 5 cm away from the start; a sensor more than 1 cm below a height field for longer than 0.05 s
/// (sim/truth/above_ground.hpp). The message names the reason and the simulated time; sweeps count such draws apart.
class SimulationFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Simulates one situation: rigid bodies and contact (MuJoCo, RK4, 0.5 ms), IMU readings, lidar sweeps, truth.
/// `threads` are for the lidar; the result does not depend on them. Throws InvalidSituation when the robot lacks a
/// sensor's site or the motion cannot be made in this world, or SimulationFailure.
Recording simulate(const BuiltSituation& built, int threads = 1);

/// Pose of the robot's body frame where a situation begins, before it has sunk into its contacts: nothing is stepped.
/// Throws InvalidSituation when the motion cannot be made in this world.
Eigen::Isometry3d start_pose(const BuiltSituation& built);

}  // namespace tumble::sim
