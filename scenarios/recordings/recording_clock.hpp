// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/import.hpp"

/// The clock of an imported recording. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Returns the first and last time of the IMU samples and sweeps; a sweep lasts one period. Throws BadInput if there
/// are none.
std::pair<std::int64_t, std::int64_t> span_of(const sim::Sensors& sensors);

/// Returns time 0 for a first stamp: that stamp, or the clock's zero if less than a second earlier.
std::int64_t origin_of(std::int64_t first_ns);

/// Converts stamps from the source's clock to the recording's clock, and stores the origin.
void start_clock(Imported& recording);

/// Adds a lidar with its points.
void add_lidar(Imported& recording, BuiltSweeps built);

/// Uses poses of a frame at T_BA on the body as the truth of a recording; stamps are in its source's clock. Messages
/// start with `where`. Throws BadInput.
void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where);

/// Returns T_BL of the first lidar. Throws BadInput, with a message that starts with `where`, if there is none.
const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
