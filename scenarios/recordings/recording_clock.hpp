// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/import.hpp"

/// The clock of an imported recording. Private to scenarios/recordings.
namespace tumble::scenarios {

/// First and last instant of the sensors: of the IMUs' samples and of the sweeps, each of which lasts its period.
/// Throws BadInput when there is none.
std::pair<std::int64_t, std::int64_t> span_of(const sim::Sensors& sensors);

/// Where a recording whose first stamp is this begins: there, or at the clock's own zero, less than a second before.
std::int64_t origin_of(std::int64_t first_ns);

/// Moves the sensors, stamped in the clock of their source, to the clock of a recording, and notes its origin.
void start_clock(Imported& recording);

/// Puts a lidar beside the others, its points with theirs.
void add_lidar(Imported& recording, BuiltSweeps built);

/// Makes poses of what stands at T_BA on the body the truth of a recording; stamps are of its source's clock. Messages
/// begin with `where`. Throws BadInput.
void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where);

/// T_BL of the first lidar. Throws BadInput beginning with `where` when there is none.
const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
