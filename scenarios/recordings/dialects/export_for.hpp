// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// The functions in export_for.hpp export recordings for published estimators; dialects/README.md describes the
/// formats.
namespace tumble::scenarios {

/// Returns the names of the published estimators for which export_for can write: dlio fast-lio glim kiss-icp lio-sam
/// norlab point-lio rko-lio.
std::vector<std::string> peer_dialects();

/// Writes a recording in the format of one published estimator to an empty or new folder. The bag has the estimator's
/// format (storage, topics, frames, point fields), and contains only the first IMU and the first lidar. The folder also
/// contains a configuration for the sensors of this recording, and manifest.json. If `with_truth` is true, the folder
/// contains truth.tum for the program evo: body poses in the bag's clock. Returns notes about omitted empty sweeps.
///
/// Throws BadInput for an unknown name; the message suggests the nearest name. Throws BadInput for a recording without
/// the lidar, IMU or point times that the estimator needs, and for errors of the bag writers.
std::vector<std::string> export_for(const std::filesystem::path& recording, const std::string& peer,
                                    const std::filesystem::path& folder, bool with_truth);

}  // namespace tumble::scenarios
