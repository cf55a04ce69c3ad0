// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/import.hpp"

/// recording_clock.hpp converts the time stamps of imported files to the clock of the recording.
namespace tumble::scenarios {

/// Returns the first and last time of IMU samples and sweeps; a sweep lasts one period. Throws BadInput if there are
/// neither IMU samples nor sweeps.
std::pair<std::int64_t, std::int64_t> span_of(const sim::Sensors& sensors);

/// StampSpan is the first and last stamp of a recording or trajectory.
using StampSpan = std::pair<std::int64_t, std::int64_t>;

/// Returns the first of `shifts_ns` by which the moved time span overlaps the fixed one; empty if none gives an
/// overlap. Exported files of a simulated recording count from kExportOrigin_ns, while other files of this recording
/// may count from zero. No recording lasts longer than a day, so this difference of 31 years is unambiguous.
std::optional<std::int64_t> clock_shift_ns(const StampSpan& moved, const StampSpan& fixed,
                                           std::initializer_list<std::int64_t> shifts_ns);

/// Describes a shift that clock_shift_ns found, for a note to the user.
std::string clock_note(const std::string& what, std::int64_t shift_ns);

/// Returns the time stamp of time 0 of a recording: its first time stamp, or the zero of the clock if it is less than a
/// second earlier. The zero of a clock is 0 or kExportOrigin_ns, the origin of exported files.
std::int64_t origin_of(std::int64_t first_ns);

/// Converts all time stamps from the clock of the source to the clock of the recording, and stores the origin.
void start_clock(Imported& recording);

/// Adds a lidar with its points to the recording.
void add_lidar(Imported& recording, BuiltSweeps built);

/// Uses the poses of a frame A, mounted at T_BA on the body, as the truth of a recording. The stamps of the poses are
/// in the clock of the recording's source. If the poses are invalid, throws BadInput with a message that starts with
/// `where`.
void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where);

/// Returns the mounting T_BL of the first lidar, to which the poses belong. If there is no lidar, throws BadInput with
/// a message that starts with `where`.
const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where);

}  // namespace tumble::scenarios
