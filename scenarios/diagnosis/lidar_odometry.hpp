// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scenarios/methods/sweep_log.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Registers the sweeps of a lidar without an IMU. `RigidOdometry` deskews each sweep with the velocity of the last
/// sweep, and aligns the rigid sweep with the map by point-to-plane ICP. Sweeps before the start of the map get no
/// report. The lidar odometry is similar to KISS-ICP (Vizzo et al., RA-L 2023).
std::vector<SweepResult> register_sweeps(const sim::LidarRecord& lidar);

struct SeenRotation {
  std::int64_t from_ns = 0, to_ns = 0;
  Eigen::Vector3d rotation_L_rad = Eigen::Vector3d::Zero();  ///< rotation vector, lidar axes
};

/// The rotations between consecutive sweeps come from the lidar alone, by `register_sweeps`. At most ten segments of a
/// dozen sweeps, spread over the recording, are processed, each with a separate map. Only pairs of registered sweeps
/// with rates of 0.1 to 2 rad/s are kept. Slower rotations are mostly noise, and faster rotations distort the sweeps.
/// seen_rotations() takes about 10 ms per sweep.
std::vector<SeenRotation> seen_rotations(const sim::LidarRecord& lidar, const PointStore* aside);

}  // namespace tumble::scenarios
