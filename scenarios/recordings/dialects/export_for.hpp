// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// export_for.hpp exports recordings for published estimators; dialects/README.md describes the formats.
namespace tumble::scenarios {

/// Returns the names of the published estimators: dlio fast-lio glim kiss-icp lio-sam norlab point-lio rko-lio.
std::vector<std::string> peer_dialects();

/// Writes a recording for one published estimator to an empty or new folder. The bag has the estimator's format
/// (storage, topics, frames, point fields), and contains only the first IMU and the first lidar. The folder also
/// contains a configuration with this recording's sensors, and manifest.json. With `with_truth`, the folder contains
/// truth.tum for evo: body poses in the bag's clock. Returns notes about omitted empty sweeps.
///
/// Throws BadInput for an unknown name; the message suggests the nearest name. Throws BadInput also for a recording
/// without the lidar, IMU or point times that the estimator needs, and for errors of the bag writers.
std::vector<std::string> export_for(const std::filesystem::path& recording, const std::string& peer,
                                    const std::filesystem::path& folder, bool with_truth);

}  // namespace tumble::scenarios
