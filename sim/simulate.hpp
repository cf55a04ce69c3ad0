// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <stdexcept>

#include "sim/recording.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// Thrown when a draw is rejected, by these rules: a warning of the engine; a state that is not finite; faster than 5
/// mm/s after the second of settling before the start; beyond the half extent of its world or 60 m below its origin;
/// never 5 cm away from the start. The message names the reason and the simulated time; sweeps count such draws apart.
class SimulationFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SimulateOptions {
  std::filesystem::path models;  ///< folder of the MJCF files
  int threads = 1;               ///< for the lidar; the result does not depend on it
};

/// Simulates one situation: rigid bodies and contact (MuJoCo, RK4, 0.5 ms), IMU readings, lidar sweeps, truth.
/// Throws InvalidSituation or SimulationFailure.
Recording simulate(const Situation& situation, const SimulateOptions& options);

/// Pose of the robot's body frame where a situation begins, before it has sunk into its contacts. Composes the world,
/// does not step it. Throws InvalidSituation.
Eigen::Isometry3d start_pose(const Situation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim
