// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Names of the files that the folder of an estimate may contain.
inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// Writes an estimate to a folder. Files without content are not written. ESTIMATE.md describes the columns.
///
/// - estimate.json: method, kind, frame, status, health, digest of the input sensors
/// - rates.csv, attitude.tum, attitude_covariance.csv
/// - trajectory.tum (t x y z qx qy qz qw), position_covariance.csv, contacts.csv
/// - sweeps.csv, sweep_poses.csv, map.ply
/// - transcript.txt: output of an external program
///
/// The file estimate.json is written last. Reading restores all scored values bit-exactly, except the last bit of
/// quaternions in TUM files, because reading normalises quaternions. For `poses`, only the position covariance is
/// written; velocities and other covariances are lost.
///
/// Throws BadInput if writing fails. Throws std::invalid_argument if the length of `contacts` differs from `poses`, or
/// if `uncertain` is neither empty nor as long as `poses`.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "");

/// Returns the digest of the sensor data from which the estimate was computed. Returns an empty text if the folder
/// states no digest.
std::string estimated_sensors(const std::filesystem::path& path);

/// Reads the folder of an estimate, or a single file of another program: TUM, or a table of poses (read_pose_table).
/// The estimate of a file has kind position, the frame `tum_frame` and the file's name. All numbers of a single file
/// must be finite. The folder of an estimate may contain NaN, because a diverged method writes NaN. Throws BadInput
/// with path, line and reason.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
