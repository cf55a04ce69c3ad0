// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_text.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::uint64_t kSeedsMax = 10'000'000;
constexpr double kTimeoutMaxS = 1e6;

std::vector<std::string> every_method() {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.push_back(full_name(method.info));
  return names;
}

void read_seeds(const YamlNode& node, Suite& suite) {
  const std::array<std::string, 2> required = {"first", "last"};
  const auto fields = node.fields(required);
  suite.first_seed = fields.at("first").unsigned_integer();
  suite.last_seed = fields.at("last").unsigned_integer();
  if (suite.last_seed < suite.first_seed) node.fail("the last seed is below the first seed of the suite");
}

std::vector<std::string> keys_of(const std::string& text, const YamlNode& node) {
  std::vector<std::string> keys;
  std::stringstream stream(text + "+");  // a trailing "+" gives an empty key
  for (std::string key; std::getline(stream, key, '+');) {
    std::erase(key, ' ');
    if (key.empty() || std::find(keys.begin(), keys.end(), key) != keys.end()) {
      node.fail(fmt::format("in the varied keys '{}', a key is empty or occurs twice", text));
    }
    keys.push_back(key);
  }
  return keys;
}

Variation read_variation(const DataRoot& data, const Suite& suite, const std::string& text, const YamlNode& node) {
  Variation curve{keys_of(text, node), {}};
  for (const YamlNode& item : node.items()) {
    const double value = item.number();
    if (std::find(curve.values.begin(), curve.values.end(), value) != curve.values.end()) {
      item.fail("a value occurs twice");
    }
    curve.values.push_back(value);
  }
  if (curve.values.empty())
    node.fail(fmt::format("the list of values of the varied key '{}' is empty; list at least one value", text));
  try {
    check(curve, data, suite.scenarios, suite.first_seed);
  } catch (const BadInput& error) {
    node.fail(error.what());
  }
  return curve;
}

void read_curves(const DataRoot& data, const YamlNode& node, Suite& suite) {
  for (const auto& [text, values] : node.entries()) {
    Variation curve = read_variation(data, suite, text, values);
    for (const Variation& other : suite.curves) {
      if (other.key() == curve.key())
        values.fail(fmt::format("the suite varies '{}' twice; list each key once", curve.key()));
    }
    suite.curves.push_back(std::move(curve));
  }
  if (suite.curves.empty())
    node.fail("the list of curves (varied parameters with their values) is empty; list at least one curve");
}

void read_scenarios(const DataRoot& data, const YamlNode& node, Suite& suite) {
  std::vector<std::string> known = scenario_names(data);
  const std::vector<std::string> cases = case_names(data);
  known.insert(known.end(), cases.begin(), cases.end());
  for (const YamlNode& item : node.items()) {
    const std::string name = item.text();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      item.fail("unknown scenario '" + name + "'" + suggestion(name, known));
    }
    if (std::find(suite.scenarios.begin(), suite.scenarios.end(), name) != suite.scenarios.end()) {
      item.fail(fmt::format("scenario '{}' occurs twice", name));
    }
    suite.scenarios.push_back(name);
  }
  if (suite.scenarios.empty()) node.fail("the list of scenarios is empty; the suite needs at least one scenario");
}

void read_classes(const DataRoot& data, const YamlNode& node, Suite& suite) {
  const std::vector<std::string> known = scenario_names(data);
  std::set<std::pair<std::string, std::uint64_t>> seen;
  for (const auto& [name, scenarios] : node.entries()) {
    DrawClass each{name, {}};
    for (const auto& [scenario, seeds] : scenarios.entries()) {
      if (!std::binary_search(known.begin(), known.end(), scenario))
        scenarios.fail("unknown scenario '" + scenario + "'" + suggestion(scenario, known));
      for (const YamlNode& seed : seeds.items()) {
        each.draws.emplace_back(scenario, seed.unsigned_integer());
        if (!seen.insert(each.draws.back()).second) seed.fail("a simulated run (scenario and seed) occurs twice");
      }
      if (std::find(suite.scenarios.begin(), suite.scenarios.end(), scenario) == suite.scenarios.end())
        suite.scenarios.push_back(scenario);
    }
    if (each.draws.empty())
      scenarios.fail("this class of simulated runs is empty; each class needs at least one simulated run");
    suite.classes.push_back(std::move(each));
  }
  if (seen.empty()) node.fail("this key lists no simulated run; the suite needs at least one simulated run");
  const auto by_seed = [](const auto& a, const auto& b) { return a.second < b.second; };
  suite.first_seed = std::min_element(seen.begin(), seen.end(), by_seed)->second;
  suite.last_seed = std::max_element(seen.begin(), seen.end(), by_seed)->second;
}

void read_metrics(const YamlNode& node, Suite& suite) {
  std::vector<std::string> known;
  for (const Metric& metric : metrics()) known.push_back(metric.info.name);
  for (const YamlNode& item : node.items()) {
    const std::string name = item.text();
    if (std::find(known.begin(), known.end(), name) == known.end())
      item.fail("unknown metric '" + name + "'" + suggestion(name, known));
    suite.shown_metrics.push_back(name);
  }
}

void read_recordings(const YamlNode& node, Suite& suite) {
  for (const YamlNode& item : node.items()) {
    if (item.text().empty()) item.fail("must name a file");
    suite.recordings.push_back(item.text());
  }
  if (suite.recordings.empty()) node.fail("the list of recordings is empty; the suite needs at least one recording");
}

void read_draws(const DataRoot& data, const YamlNode& root, const std::map<std::string, YamlNode>& fields,
                Suite& suite) {
  if (fields.contains("recordings")) {
    for (const char* key : {"scenarios", "seeds", "draws", "vary"}) {
      if (fields.contains(key)) fields.at(key).fail("this key is not allowed in a suite of recordings; remove the key");
    }
    read_recordings(fields.at("recordings"), suite);
    return;
  }
  if (fields.contains("draws")) {
    for (const char* key : {"scenarios", "seeds"}) {
      if (fields.contains(key))
        fields.at(key).fail(
            "this key is not allowed in a suite that lists its simulated runs (key 'draws'); remove the key");
    }
    read_classes(data, fields.at("draws"), suite);
    return;
  }
  for (const char* key : {"scenarios", "seeds"}) {
    if (!fields.contains(key)) root.fail(fmt::format("key '{}' is missing", key));
  }
  read_seeds(fields.at("seeds"), suite);
  read_scenarios(data, fields.at("scenarios"), suite);
}

std::string method_name(const std::string& text, const std::filesystem::path& folder) {
  return is_method_file(text) ? (folder / text).string() : text;
}

void require_no_scenario(const YamlNode& root) {
  if (!root.is_map()) return;
  for (const auto& [key, value] : root.entries()) {
    if (key == "motion")
      value.fail(
          "this key belongs to a scenario file, but a suite file is expected. Move the file to scenarios/catalogue and "
          "give the name of the scenario, or use the file with 'tumble run'");
  }
}

Suite read_suite(const DataRoot& data, const std::filesystem::path& path) {
  const YamlNode root = YamlNode::parse(read_text_file(path), path.string());
  require_no_scenario(root);
  const std::array<std::string, 2> required = {"name", "doc"};
  const std::array<std::string, 8> optional = {"scenarios", "seeds",   "draws",     "recordings",
                                               "methods",   "metrics", "timeout_s", "vary"};
  const auto fields = root.fields(required, optional);
  Suite suite;
  suite.name = fields.at("name").identifier();
  suite.doc = fields.at("doc").text();
  suite.recordings_folder = path.parent_path();
  read_draws(data, root, fields, suite);
  if (fields.contains("metrics")) read_metrics(fields.at("metrics"), suite);
  if (fields.contains("methods")) {
    for (const YamlNode& item : fields.at("methods").items()) {
      suite.methods.push_back(method_name(item.text(), path.parent_path()));
      try {
        find_methods(suite.methods.back());
      } catch (const BadInput& error) {
        item.fail(error.what());
      }
    }
    if (suite.methods.empty())
      fields.at("methods").fail("the list of methods is empty; the suite needs at least one method");
  } else {
    suite.methods = every_method();
  }
  if (fields.contains("timeout_s")) {
    suite.timeout_s = fields.at("timeout_s").number();
    if (!(suite.timeout_s > 0.0 && suite.timeout_s <= kTimeoutMaxS)) {
      fields.at("timeout_s").fail("the time limit of a method must be within (0, 1e6] s");
    }
  }
  if (fields.contains("vary")) read_curves(data, fields.at("vary"), suite);
  return suite;
}

Suite suite_of_scenario(const std::string& name) {
  Suite suite;
  suite.name = name;
  suite.doc = fmt::format("runs every method on the scenario {}", name);
  suite.scenarios = {name};
  suite.methods = every_method();
  return suite;
}

}  // namespace

bool Suite::has_draw(const std::string& scenario, std::uint64_t seed) const {
  const auto holds = [&](const DrawClass& each) {
    return std::find(each.draws.begin(), each.draws.end(), std::pair(scenario, seed)) != each.draws.end();
  };
  return classes.empty() || std::any_of(classes.begin(), classes.end(), holds);
}

std::uint64_t Suite::draw_count() const {
  if (classes.empty()) return scenarios.size() * (last_seed - first_seed + 1);
  std::uint64_t count = 0;
  for (const DrawClass& each : classes)
    for (const auto& [scenario, seed] : each.draws) count += seed >= first_seed && seed <= last_seed ? 1 : 0;
  return count;
}

void require_seeds(const Suite& suite) {
  if (suite.last_seed < suite.first_seed)
    throw BadInput(fmt::format("suite {}: the last seed is below the first seed", suite.name));
  if (suite.last_seed - suite.first_seed >= kSeedsMax)
    throw BadInput(fmt::format("suite {}: the suite has more than {} seeds; split the range of seeds into parts",
                               suite.name, kSeedsMax));
}

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
      throw BadInput(
          fmt::format("{}: the name is '{}'; it must be the name of the file, '{}'", path.string(), suite.name, name));
    return suite;
  }
  const std::vector<std::string> scenarios = scenario_names(data), cases = case_names(data);
  if (std::binary_search(scenarios.begin(), scenarios.end(), name)) return suite_of_scenario(name);
  if (std::binary_search(cases.begin(), cases.end(), name)) {
    Suite suite = suite_of_scenario(name);
    suite.first_seed = suite.last_seed = load_scenario(data, name).named_case.value().seed;
    return suite;
  }
  suites.insert(suites.end(), cases.begin(), cases.end());
  suites.insert(suites.end(), scenarios.begin(), scenarios.end());
  throw BadInput(fmt::format("unknown suite or scenario '{}'{}", name, suggestion(name, suites)));
}

}  // namespace tumble::scenarios
