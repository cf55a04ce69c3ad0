// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_text.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

std::vector<std::string> scenario_names(const DataRoot& data) {
  return yaml_stems(data.catalogue());
}

std::vector<std::string> case_names(const DataRoot& data) {
  return std::filesystem::is_directory(data.regressions()) ? yaml_stems(data.regressions())
                                                           : std::vector<std::string>{};
}

namespace {

std::filesystem::path find_scenario(const DataRoot& data, std::span<const std::string> cases, const std::string& name) {
  std::vector<std::string> known = scenario_names(data);
  if (std::binary_search(known.begin(), known.end(), name)) return data.catalogue() / (name + ".yaml");
  known.insert(known.end(), cases.begin(), cases.end());
  throw BadInput("unknown scenario '" + name + "'" + suggestion(name, known));
}

/// `derived` contains the scenario files that extend the loaded file (YAML key `extends`).
Scenario load_file(const DataRoot& data, const std::filesystem::path& path, const Registry& registry,
                   std::vector<std::filesystem::path> derived = {}) {
  derived.push_back(std::filesystem::weakly_canonical(path));
  return parse_scenario(read_text_file(path), path.string(), registry, [&](const YamlNode& extends) {
    const std::string name = extends.identifier(), file = name + ".yaml";
    // If a scenario file extends a scenario that has the file's own name, the base scenario is the file of this name in
    // scenarios/catalogue.
    std::filesystem::path base = std::filesystem::weakly_canonical(path.parent_path() / file);
    if (base == derived.back() || !std::filesystem::exists(base))
      base = std::filesystem::weakly_canonical(data.catalogue() / file);
    if (!std::filesystem::exists(base))
      extends.fail("unknown scenario '" + name + "'" + suggestion(name, scenario_names(data)));
    if (std::find(derived.begin(), derived.end(), base) != derived.end())
      extends.fail(
          fmt::format("the keys 'extends' of scenario '{}' and its bases form a loop; remove one key 'extends'", name));
    return load_file(data, base, registry, derived);
  });
}

}  // namespace

Scenario load_scenario(const DataRoot& data, const std::string& name) {
  const Registry registry = Registry::of_simulation();
  if (name.ends_with(".yaml")) return load_file(data, name, registry);
  const std::vector<std::string> cases = case_names(data);
  const bool is_case = std::binary_search(cases.begin(), cases.end(), name);
  if (is_case && std::filesystem::exists(data.catalogue() / (name + ".yaml")))
    throw BadInput(fmt::format("a scenario and a named case have the same name, '{}'; rename one of them", name));
  const std::filesystem::path path = is_case ? data.regressions() / (name + ".yaml") : find_scenario(data, cases, name);
  Scenario scenario = load_file(data, path, registry);
  if (scenario.name != name) {
    throw BadInput(
        fmt::format("{}: the name is '{}'; it must be the name of the file, '{}'", path.string(), scenario.name, name));
  }
  if (is_case && !scenario.named_case)
    throw BadInput(fmt::format(
        "{}: the key 'case' is missing; the file of a named case must contain the expected results under this key",
        path.string()));
  return scenario;
}

}  // namespace tumble::scenarios
