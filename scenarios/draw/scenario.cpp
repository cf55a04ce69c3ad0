// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario.hpp"

#include <algorithm>

#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_folder.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

std::vector<std::string> scenario_names(const DataRoot& data) {
  return yaml_stems(data.catalogue());
}

Scenario load_scenario(const DataRoot& data, const std::string& name) {
  const Registry registry = Registry::of_simulation();
  if (name.ends_with(".yaml")) return parse_scenario(read_text_file(name), name, registry);
  const std::filesystem::path path = find_yaml(data.catalogue(), "scenario", name);
  Scenario scenario = parse_scenario(read_text_file(path), path.string(), registry);
  if (scenario.name != name) {
    throw BadInput(path.string() + ": name is '" + scenario.name + "', must be the file's, '" + name + "'");
  }
  return scenario;
}

}  // namespace tumble::scenarios
