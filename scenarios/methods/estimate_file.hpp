// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// What the folder of an estimate may hold.
inline constexpr const char* kEstimateFiles[] = {"estimate.json",           "rates.csv",     "attitude.tum",
                                                 "trajectory.tum",          "contacts.csv",  "sweeps.csv",
                                                 "sweep_poses.csv",         "map.ply",       "position_covariance.csv",
                                                 "attitude_covariance.csv", "transcript.txt"};

/// Leaves an estimate in a folder: estimate.json (method, kind, frame, status, health, digest of the sensors that it
/// was made from), rates.csv, attitude.tum, attitude_covariance.csv, trajectory.tum (t x y z qx qy qz qw),
/// position_covariance.csv, contacts.csv, sweeps.csv, sweep_poses.csv, map.ply, transcript.txt (what somebody else's
/// program said); only the files that apply, estimate.json last. Everything that is scored comes back the same to the
/// bit, but for the last bit of a quaternion in a TUM file (it is normalised on reading). Covariances of `poses` but
/// for the position, and the velocities of `poses` are not written. Throws BadInput when it cannot write,
/// std::invalid_argument when `contacts` is not as long as `poses`, or `uncertain` neither empty nor as long. Columns:
/// ESTIMATE.md.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate,
                    const std::string& sensors_digest = "");

/// The digest of the sensors that an estimate in a folder was made from; empty where it does not say.
std::string estimated_sensors(const std::filesystem::path& path);

/// Reads such a folder back, or a single TUM file of somebody else's (kind position, poses of `tum_frame`, named after
/// the file; of a file each number must be finite, in a folder NaN is what a method left that broke down). Throws
/// BadInput with path, line and reason.
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
