// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Leaves an estimate in a folder: estimate.json (method, kind, status, health), rates.csv, attitude.tum, trajectory.tum
/// (t x y z qx qy qz qw), sweeps.csv, map.ply; only the files that apply. Throws BadInput when it cannot write.
void write_estimate(const std::filesystem::path& folder, const std::string& method, Kind kind, const Estimate& estimate);

/// Reads such a folder back, or a single TUM file of somebody else's (kind position, poses in `frame`).
Estimate read_estimate(const std::filesystem::path& path, Kind& kind, std::string& method, Frame tum_frame);

}  // namespace tumble::scenarios
