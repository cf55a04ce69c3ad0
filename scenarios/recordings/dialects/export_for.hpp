// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Exports recordings for published estimators: dialects/README.md.
namespace tumble::scenarios {

/// Returns the peer names: dlio fast-lio glim kiss-icp lio-sam norlab point-lio rko-lio.
std::vector<std::string> peer_dialects();

/// Writes a recording for one peer to an empty or new folder. Writes the bag in its format (storage, topics, frames,
/// point fields; only the first IMU and first lidar), its configuration with this recording's sensors, and
/// manifest.json. `with_truth` adds truth.tum for evo: body poses in the bag's clock. Returns notes on omitted empty
/// sweeps.
///
/// Throws BadInput: an unknown name (suggests the nearest), a recording without the lidar, IMU or point times that the
/// peer needs, or errors of the bag writers.
std::vector<std::string> export_for(const std::filesystem::path& recording, const std::string& peer,
                                    const std::filesystem::path& folder, bool with_truth);

}  // namespace tumble::scenarios
