// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble::scenarios {

std::string yaml_number(double value, const std::string& place);

std::string yaml_word(const std::string& text);

/// Returns the YAML lines of the key `streams`, which contains the seed of each random stream.
std::string streams_text(const std::map<std::string, std::uint64_t>& streams);

std::vector<std::string> yaml_stems(const std::filesystem::path& folder);

std::filesystem::path find_yaml(const std::filesystem::path& folder, const std::string& what, const std::string& name);

}  // namespace tumble::scenarios
