// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Recordings as published estimators read them: dialects/README.md.
namespace tumble::scenarios {

/// Names that export_for takes: dlio fast-lio glim kiss-icp lio-sam norlab point-lio rko-lio.
std::vector<std::string> peer_dialects();

/// Writes a recording for one peer into a folder, which is made when absent and must be empty: the bag that it reads
/// (its storage, topics, frames, point fields; first IMU and first lidar alone), its own configuration with this
/// recording's sensors, and manifest.json. `with_truth`: truth.tum beside it, poses of the body in the bag's clock,
/// for evo. Returns how many sweeps without a point were left out, where there are such and the peer cannot take them.
/// Throws BadInput: an unknown name (the nearest is named), a recording without lidar, IMU or times of points
/// where the peer needs them, what the bags' writers say.
std::vector<std::string> export_for(const std::filesystem::path& recording, const std::string& peer,
                                    const std::filesystem::path& folder, bool with_truth);

}  // namespace tumble::scenarios
