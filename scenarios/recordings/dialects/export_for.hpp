// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Exports recordings for published estimators; dialects/README.md describes the formats.
namespace tumble::scenarios {

/// Returns the names of the published estimators: dlio fast-lio glim kiss-icp lio-sam norlab point-lio rko-lio.
std::vector<std::string> peer_dialects();

/// Writes a recording for one published estimator to an empty or new folder. Writes the bag in the estimator's format
/// (storage, topics, frames, point fields; only the first IMU and first lidar), a configuration with this recording's
/// sensors, and manifest.json. With `with_truth`, also writes truth.tum for evo: body poses in the bag's clock. Returns
/// notes on omitted empty sweeps.
///
/// Throws BadInput for an unknown name (suggests the nearest name), for a recording without the lidar, IMU or point
/// times that the estimator needs, and for errors of the bag writers.
std::vector<std::string> export_for(const std::filesystem::path& recording, const std::string& peer,
                                    const std::filesystem::path& folder, bool with_truth);

}  // namespace tumble::scenarios
