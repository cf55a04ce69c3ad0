// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <system_error>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

/// Makes the folder when it is absent. Throws BadInput with the system's reason.
inline void require_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw BadInput(folder.string() + ": cannot be written: " + error.message());
}

/// A sensor's name as the stem of a file: a name out of a recording must not lead out of the folder.
inline std::string file_stem(const std::string& name, const std::string& kind, std::size_t index) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return name;
  return kind + "_" + std::to_string(index);
}

}  // namespace tumble::scenarios
