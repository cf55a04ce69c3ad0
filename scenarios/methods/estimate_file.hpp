// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// kEstimateFiles lists the files that the folder of an estimate may contain.
inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// Writes an estimate to a folder. Files without content are not written. ESTIMATE.md describes the columns.
///
/// - The file estimate.json contains method, kind, frame, status, health, digest of the input sensors, and the
///   recording's `origin_ns` (RecordingInfo).
/// - The rates and attitudes are in rates.csv, attitude.tum and attitude_covariance.csv.
/// - The poses are in trajectory.tum (t x y z qx qy qz qw), position_covariance.csv and contacts.csv.
/// - The sweeps and the map are in sweeps.csv, sweep_poses.csv and map.ply.
/// - The file transcript.txt contains the output of an external program.
///
/// estimate.json is written last. Reading restores all scored values bit-exactly, except that TUM quaternions are
/// normalised and may change in the last bit. Of the members of `poses`, velocities are not stored, and only the
/// position covariance is stored.
///
/// Throws BadInput if writing fails. Throws std::invalid_argument if `contacts` or a non-empty `uncertain` differs in
/// length from `poses`.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "", std::int64_t origin_ns = 0);

/// Returns the digest of the sensor data from which the estimate was computed; empty if the folder contains no digest.
std::string estimated_sensors(const std::filesystem::path& path);

/// Reads an estimate from a folder, or from a single file of another program: TUM, or a table of poses
/// (read_pose_table). An estimate from a single file has the kind position and the frame `tum_frame`; its method is the
/// file's name. A folder may contain NaN, which a diverged method writes; a single file must contain only finite
/// numbers. Throws BadInput with path, line and reason if reading fails.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
