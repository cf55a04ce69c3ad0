// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/import.hpp"

namespace tumble::scenarios {

std::pair<std::int64_t, std::int64_t> span_of(const sim::Sensors& sensors);

using StampSpan = std::pair<std::int64_t, std::int64_t>;

/// Tries the time shifts `shifts_ns` in order. Returns the first shift after which the time span `moved` overlaps the
/// time span `fixed`, or nothing. Exported files of a simulation start at kExportOrigin_ns (31 years), but a simulated
/// recording starts at zero.
std::optional<std::int64_t> clock_shift_ns(const StampSpan& moved, const StampSpan& fixed,
                                           std::initializer_list<std::int64_t> shifts_ns);

std::string clock_note(const std::string& what, std::int64_t shift_ns);

/// Returns the time stamp in the source file that becomes time 0 of a recording:
/// - 0 if the first stamp is at least 0 and below 1 s
/// - kExportOrigin_ns (the origin of exported files) if the first stamp is less than a second after kExportOrigin_ns
/// - the first stamp in all other cases
std::int64_t origin_of(std::int64_t first_ns);

void start_clock(Imported& recording);

void add_lidar(Imported& recording, BuiltSweeps built);

/// Uses the poses of a frame A, mounted at T_BA on the body, as the truth of a recording.
void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where);

const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
