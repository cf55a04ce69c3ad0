// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/sweep_log.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Registers the sweeps of a lidar without an IMU. `RigidOdometry` deskews each sweep with the velocity of the last
/// sweep, and aligns the rigid sweep with the map by point-to-plane ICP. Sweeps before the start of the map get no
/// report. The lidar odometry is similar to KISS-ICP (Vizzo et al., RA-L 2023).
std::vector<SweepResult> register_sweeps(const sim::LidarRecord& lidar);

}  // namespace tumble::scenarios
