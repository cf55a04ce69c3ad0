// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>

#include "sim/recording.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// Thrown when a draw cannot be trusted: a warning of the engine, a state that is not finite, a robot that left its
/// world or never moved. The message names the reason and the simulated time.
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

}  // namespace tumble::sim
