// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

std::vector<std::string> peer_dialects();

/// Exports a recording in the format that one published estimator expects, to an empty or new folder. If `with_truth`
/// is true, the folder contains truth.tum for the program evo: body poses in the bag's clock.
std::vector<std::string> export_for(const std::filesystem::path& recording, const std::string& peer,
                                    const std::filesystem::path& folder, bool with_truth);

}  // namespace tumble::scenarios
