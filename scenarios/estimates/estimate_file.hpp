// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenarios/estimates/estimate.hpp"

namespace tumble::scenarios {

inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// Writes the files of an estimate to a folder; ESTIMATE.md describes their columns.
///
/// read_estimate() restores all scored values bit-exactly, except that TUM quaternions are normalised. The files
/// contain no velocities and, for poses, only the position part of the covariance.
///
/// Throws std::invalid_argument if `contacts` is not empty and differs in length from `poses`, or if `uncertain` is not
/// empty and differs in length from `contacts`.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "", std::int64_t origin_ns = 0);

std::string estimated_sensors(const std::filesystem::path& path);

/// Reads an estimate from a folder, or from a single pose file of another program. The pose file is a TUM file, or a
/// table that read_pose_table() can read. An estimate from a single file has the kind `position`, and `tum_frame`
/// states the frame of its poses. Numbers in a single file must be finite, whereas the folder of an estimate may
/// contain NaN from a diverged method.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
