// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// ESTIMATE.md describes the columns.
/// - estimate.json: method, kind, frame, status, health, digest of the input sensors, and the recording's `origin_ns`
/// - rates.csv, attitude.tum, attitude_covariance.csv: rates and attitudes
/// - trajectory.tum (t x y z qx qy qz qw), position_covariance.csv, contacts.csv: poses
/// - sweeps.csv, sweep_poses.csv, map.ply: sweeps and map
/// - transcript.txt: output of an external program
///
/// Reading restores all scored values bit-exactly, except that TUM quaternions are normalised. Velocities, and
/// covariances of poses other than the position covariance, are not stored.
///
/// Throws BadInput if writing fails. Throws std::invalid_argument if `contacts` or a non-empty `uncertain` differs in
/// length from `poses`.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "", std::int64_t origin_ns = 0);

std::string estimated_sensors(const std::filesystem::path& path);

/// Reads a folder, or a single file of another program: TUM, or a table of poses (read_pose_table). An estimate from a
/// single file has the kind position and the frame `tum_frame`; its method is the file's name. Only a folder may
/// contain NaN, which a diverged method writes. Throws BadInput with path, line and reason if reading fails.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
