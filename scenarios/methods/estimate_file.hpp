// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// kEstimateFiles contains the names of the files that the folder of an estimate may contain.
inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// Writes an estimate to a folder. A file without content is not written. ESTIMATE.md describes the columns of the
/// files.
///
/// - The file estimate.json contains method, kind, frame, status, health, digest of the input sensors, and the
///   recording's `origin_ns` (RecordingInfo).
/// - The rates and attitudes are in rates.csv, attitude.tum and attitude_covariance.csv.
/// - The poses are in trajectory.tum (t x y z qx qy qz qw), position_covariance.csv and contacts.csv.
/// - The sweeps and the map are in sweeps.csv, sweep_poses.csv and map.ply.
/// - The file transcript.txt contains the output of an external program.
///
/// The file estimate.json is written last. Reading an estimate restores all scored values bit-exactly, except that TUM
/// quaternions are normalised and may change in the last bit. For `poses`, the files contain only the position
/// covariance, without velocities and other covariances.
///
/// Throws BadInput if writing fails. Throws std::invalid_argument if the length of `contacts` differs from `poses`, or
/// if `uncertain` is neither empty nor as long as `poses`.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "", std::int64_t origin_ns = 0);

/// Returns the digest of the sensor data from which the estimate in a folder was computed. Returns an empty text if the
/// folder contains no digest.
std::string estimated_sensors(const std::filesystem::path& path);

/// Reads an estimate from a folder, or from a single file of another program: TUM, or a table of poses
/// (read_pose_table). An estimate from a single file has the kind position, the frame `tum_frame` and the file's name
/// as method. All numbers of a single file must be finite. The folder of an estimate may contain NaN, because a
/// diverged method writes NaN. Throws BadInput with path, line and reason if reading fails.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
