// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/import.hpp"

/// recording_clock.hpp converts stamps of imported files to the recording's clock.
namespace tumble::scenarios {

/// Returns the first and last time of the IMU samples and sweeps; a sweep lasts one period. Throws BadInput if the
/// recording has neither IMU samples nor sweeps.
std::pair<std::int64_t, std::int64_t> span_of(const sim::Sensors& sensors);

/// StampSpan is the first and last stamp of a recording or trajectory.
using StampSpan = std::pair<std::int64_t, std::int64_t>;

/// Returns the first of `shifts_ns` for which the shifted stamps `moved` overlap with `fixed`. Returns nothing if no
/// shift fits. Exports of a simulated recording count from kExportOrigin_ns, but other files of this recording may
/// count from zero. No recording lasts longer than a day, so an offset of 31 years is unambiguous.
std::optional<std::int64_t> clock_shift_ns(const StampSpan& moved, const StampSpan& fixed,
                                           std::initializer_list<std::int64_t> shifts_ns);

/// Returns a note about a shift that clock_shift_ns found.
std::string clock_note(const std::string& what, std::int64_t shift_ns);

/// Returns the time 0 of a recording, given its first stamp. Time 0 is the first stamp, or the zero of the clock if
/// that zero is less than a second earlier. The zero of a clock is 0 or the start of exports, kExportOrigin_ns.
std::int64_t origin_of(std::int64_t first_ns);

/// Converts stamps from the source's clock to the recording's clock, and stores the origin.
void start_clock(Imported& recording);

/// Adds a lidar with its points to the recording.
void add_lidar(Imported& recording, BuiltSweeps built);

/// Uses poses of a frame A, mounted at T_BA on the body, as the truth of a recording. The stamps of the poses are in
/// the clock of the recording's source. Error messages start with `where`. Throws BadInput if the poses are invalid.
void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where);

/// Returns the mounting T_BL of the first lidar. Throws BadInput, with a message that starts with `where`, if there is
/// no lidar.
const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
