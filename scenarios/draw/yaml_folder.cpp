// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/yaml_folder.hpp"

#include <algorithm>
#include <system_error>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

std::vector<std::string> yaml_stems(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  if (error) throw BadInput(folder.string() + ": " + error.message());
  std::vector<std::string> names;
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path find_yaml(const std::filesystem::path& folder, const std::string& what, const std::string& name) {
  const std::vector<std::string> names = yaml_stems(folder);
  if (!std::binary_search(names.begin(), names.end(), name)) {
    throw BadInput("unknown " + what + " '" + name + "'" + suggestion(name, names));
  }
  return folder / (name + ".yaml");
}

}  // namespace tumble::scenarios
