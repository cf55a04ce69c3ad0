// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Names of the files NAME.yaml in a folder, sorted. Throws BadInput when there is no such folder.
std::vector<std::string> yaml_stems(const std::filesystem::path& folder);

/// Path of NAME.yaml in a folder. Throws BadInput "unknown scenario 'hil'; did you mean 'hill'?"; `what` names the
/// thing.
std::filesystem::path find_yaml(const std::filesystem::path& folder, const std::string& what, const std::string& name);

}  // namespace tumble::scenarios
