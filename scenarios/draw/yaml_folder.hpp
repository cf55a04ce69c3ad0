// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Returns the names of the files NAME.yaml in a folder, sorted. Throws BadInput if the folder does not exist.
std::vector<std::string> yaml_stems(const std::filesystem::path& folder);

/// Returns the path of NAME.yaml in a folder. If the file does not exist, throws BadInput with a message such as
/// "unknown scenario 'hil'; did you mean 'hill'?". `what` is the noun in the message, here "scenario".
std::filesystem::path find_yaml(const std::filesystem::path& folder, const std::string& what, const std::string& name);

}  // namespace tumble::scenarios
