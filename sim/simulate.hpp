// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <stdexcept>

#include "sim/built_situation.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

class SimulationFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Simulates one recording. `threads` is the number of threads of the lidar simulation; the result does not depend on
/// `threads`.
Recording simulate(const BuiltSituation& built, int threads = 1);

/// Returns the initial pose of the robot's body frame, before the robot comes to rest on its contacts.
Eigen::Isometry3d start_pose(const BuiltSituation& built);

}  // namespace tumble::sim
