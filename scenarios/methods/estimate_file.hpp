// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// File names that the folder of an estimate may contain.
inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// Writes an estimate to a folder. Only files that apply are written, estimate.json last. Columns: ESTIMATE.md.
///
/// - estimate.json: method, kind, frame, status, health, digest of the input sensors
/// - rates.csv, attitude.tum, attitude_covariance.csv
/// - trajectory.tum (t x y z qx qy qz qw), position_covariance.csv, contacts.csv
/// - sweeps.csv, sweep_poses.csv, map.ply
/// - transcript.txt: output of an external program
///
/// All scored values are restored bit-exactly. The only exception is the last bit of quaternions in TUM files, which
/// are normalised on reading. Velocities of `poses`, and covariances of `poses` other than position, are not written.
///
/// Throws BadInput if writing fails. Throws std::invalid_argument if `contacts` is not as long as `poses`, or
/// `uncertain` is neither empty nor as long.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "");

/// Returns the digest of the sensors that an estimate was computed from; empty if the folder does not state one.
std::string estimated_sensors(const std::filesystem::path& path);

/// Reads such a folder, or a single TUM file of another program. A TUM file has kind position, poses of `tum_frame`,
/// and the file's name; all its numbers must be finite. A folder may contain NaN, which a diverged method writes.
/// Throws BadInput with path, line and reason.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
