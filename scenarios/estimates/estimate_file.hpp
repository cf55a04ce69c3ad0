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

/// ESTIMATE.md describes the columns of the files of an estimate.
///
/// read_estimate() restores all scored values bit-exactly, except that TUM quaternions are normalised. The files
/// contain no velocities and, for poses, only the position part of the covariance.
///
/// Throws std::invalid_argument if `contacts` or a non-empty `uncertain` differs in length from `poses`.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "", std::int64_t origin_ns = 0);

std::string estimated_sensors(const std::filesystem::path& path);

/// Reads the folder of an estimate, or a single pose file of another program: a TUM file, or another table of poses
/// (read_pose_table). An estimate from a single file has the kind `position`, and `tum_frame` states the frame of its
/// poses. Numbers in a single file must be finite, whereas the folder of an estimate may contain NaN from a diverged
/// method.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
