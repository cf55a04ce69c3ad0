// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

std::vector<std::string> yaml_stems(const std::filesystem::path& folder);

std::filesystem::path find_yaml(const std::filesystem::path& folder, const std::string& what, const std::string& name);

}  // namespace tumble::scenarios
