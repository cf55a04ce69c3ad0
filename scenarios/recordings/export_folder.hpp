// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace tumble::scenarios {

/// A sensor's name as the stem of a file: a name out of a recording must not lead out of the folder.
inline std::string file_stem(const std::string& name, const std::string& kind, std::size_t index) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return name;
  return kind + "_" + std::to_string(index);
}

}  // namespace tumble::scenarios
