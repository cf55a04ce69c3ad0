// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_folder.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTimeoutMaxS = 1e6;

std::vector<std::string> every_method() {
  std::vector<std::string> names;
  for (const Method& method : methods())
    names.push_back(std::string(to_string(method.info.kind)) + "/" + method.info.name);
  return names;
}

void read_seeds(const YamlNode& node, Suite& suite) {
  const std::array<std::string, 2> required = {"first", "last"};
  const auto fields = node.fields(required);
  suite.first_seed = fields.at("first").unsigned_integer();
  suite.last_seed = fields.at("last").unsigned_integer();
  if (suite.last_seed < suite.first_seed) node.fail("last is below first");
}

// names are checked here, so that a suite with a slip of the pen does not begin
Suite read_suite(const DataRoot& data, const std::filesystem::path& path) {
  const YamlNode root = YamlNode::parse(read_text_file(path), path.string());
  const std::array<std::string, 4> required = {"name", "doc", "scenarios", "seeds"};
  const std::array<std::string, 2> optional = {"methods", "timeout_s"};
  const auto fields = root.fields(required, optional);
  Suite suite;
  suite.name = fields.at("name").identifier();
  suite.doc = fields.at("doc").text();
  read_seeds(fields.at("seeds"), suite);
  const std::vector<std::string> known = scenario_names(data);
  for (const YamlNode& item : fields.at("scenarios").items()) {
    const std::string name = item.text();
    if (!std::binary_search(known.begin(), known.end(), name)) {
      item.fail("unknown scenario '" + name + "'" + suggestion(name, known));
    }
    suite.scenarios.push_back(name);
  }
  if (suite.scenarios.empty()) fields.at("scenarios").fail("no scenario");
  if (fields.contains("methods")) {
    for (const YamlNode& item : fields.at("methods").items()) {
      try {
        find_methods(item.text());
      } catch (const BadInput& error) {
        item.fail(error.what());
      }
      suite.methods.push_back(item.text());
    }
    if (suite.methods.empty()) fields.at("methods").fail("no method");
  } else {
    suite.methods = every_method();
  }
  if (fields.contains("timeout_s")) {
    suite.timeout_s = fields.at("timeout_s").number();
    if (!(suite.timeout_s > 0.0 && suite.timeout_s <= kTimeoutMaxS)) {
      fields.at("timeout_s").fail("must be within (0, 1e6] s");
    }
  }
  return suite;
}

}  // namespace

std::vector<std::string> suite_names(const DataRoot& data) {
  return yaml_stems(data.suites());
}

Suite load_suite(const DataRoot& data, const std::string& name) {
  if (name.ends_with(".yaml")) return read_suite(data, name);
  std::vector<std::string> suites = suite_names(data);
  if (std::binary_search(suites.begin(), suites.end(), name)) {
    const std::filesystem::path path = data.suites() / (name + ".yaml");
    Suite suite = read_suite(data, path);
    if (suite.name != name)
      throw BadInput(path.string() + ": name is '" + suite.name + "', must be the file's, '" + name + "'");
    return suite;
  }
  const std::vector<std::string> scenarios = scenario_names(data);
  if (std::binary_search(scenarios.begin(), scenarios.end(), name)) {
    Suite suite;
    suite.name = name;
    suite.doc = "every method on the scenario " + name;
    suite.scenarios = {name};
    suite.methods = every_method();
    return suite;
  }
  suites.insert(suites.end(), scenarios.begin(), scenarios.end());
  throw BadInput("unknown suite or scenario '" + name + "'" + suggestion(name, suites));
}

}  // namespace tumble::scenarios
