// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_folder.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/gate.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array kStatistics = {Statistic::median, Statistic::quantile_05, Statistic::quantile_95,
                                    Statistic::share_not_ok};
constexpr std::array kKinds = {Kind::rate, Kind::attitude, Kind::position, Kind::slam};

/// The entry of a list of enumerators that is called as the node says.
template <typename Enumerator, std::size_t kCount>
Enumerator named(const YamlNode& node, const std::array<Enumerator, kCount>& all, const char* what) {
  std::vector<std::string> known;
  for (const Enumerator each : all) {
    if (node.text() == to_string(each)) return each;
    known.emplace_back(to_string(each));
  }
  node.fail(std::string("unknown ") + what + " '" + node.text() + "'" + suggestion(node.text(), known));
}

void check_names(const YamlNode& node, const GateBound& bound) {
  try {
    find_methods(std::string(to_string(bound.kind)) + "/" + bound.method);
  } catch (const BadInput& error) {
    node.fail(error.what());
  }
  if (bound.statistic == Statistic::share_not_ok) {
    if (!bound.metric.empty()) node.fail("share_not_ok is of no metric");
    return;
  }
  std::vector<std::string> known;
  for (const Metric& metric : metrics()) {
    if (metric.kind == bound.kind) known.push_back(metric.name);
  }
  if (std::find(known.begin(), known.end(), bound.metric) == known.end()) {
    node.fail("unknown metric '" + bound.metric + "' of kind " + to_string(bound.kind) +
              suggestion(bound.metric, known));
  }
}

GateBound read_bound(const YamlNode& node) {
  const std::array<std::string, 5> required = {"scenario", "kind", "method", "statistic", "accepted"};
  const std::array<std::string, 3> optional = {"metric", "low", "high"};
  const auto fields = node.fields(required, optional);
  GateBound bound;
  bound.scenario = fields.at("scenario").identifier();
  bound.kind = named(fields.at("kind"), kKinds, "kind");
  bound.method = fields.at("method").identifier();
  bound.statistic = named(fields.at("statistic"), kStatistics, "statistic");
  bound.accepted = fields.at("accepted").number();
  if (fields.contains("metric")) bound.metric = fields.at("metric").identifier();
  if (fields.contains("low")) bound.low = fields.at("low").number();
  if (fields.contains("high")) bound.high = fields.at("high").number();
  if (!fields.contains("low") && !fields.contains("high")) node.fail("a bound needs low or high");
  if (bound.high < bound.low) node.fail("high is below low");
  check_names(node, bound);
  return bound;
}

std::string number_text(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace

std::vector<std::string> gate_names(const DataRoot& data) {
  return std::filesystem::is_directory(data.gates()) ? yaml_stems(data.gates()) : std::vector<std::string>{};
}

Gate load_gate(const DataRoot& data, const std::string& name) {
  const std::filesystem::path path =
      name.ends_with(".yaml") ? std::filesystem::path(name) : data.gates() / (name + ".yaml");
  if (!std::filesystem::exists(path)) {
    throw BadInput("no accepted bounds of '" + name + "'" + suggestion(name, gate_names(data)) + "; 'tumble gate " +
                   name + " --accept' makes them");
  }
  const YamlNode root = YamlNode::parse(read_text_file(path), path.string());
  const std::array<std::string, 3> required = {"suite", "margin", "bounds"};
  const auto fields = root.fields(required);
  Gate gate;
  gate.suite = fields.at("suite").text();
  gate.margin = fields.at("margin").number();
  for (const YamlNode& item : fields.at("bounds").items()) gate.bounds.push_back(read_bound(item));
  if (gate.bounds.empty()) fields.at("bounds").fail("no bound");
  return gate;
}

std::string to_yaml(const Gate& gate) {
  std::string text =
      "# SPDX-License-Identifier: BSD-3-Clause\n"
      "# Written by 'tumble gate " +
      gate.suite + " --accept': what a run reached, and how far a later one may fall behind.\n";
  text += "suite: " + gate.suite + "\nmargin: " + number_text(gate.margin) + "\nbounds:\n";
  for (const GateBound& bound : gate.bounds) {
    text += "  - {scenario: " + bound.scenario + ", kind: " + to_string(bound.kind) + ", method: " + bound.method;
    if (!bound.metric.empty()) text += ", metric: " + bound.metric;
    text += std::string(", statistic: ") + to_string(bound.statistic) + ", accepted: " + number_text(bound.accepted);
    if (std::isfinite(bound.low)) text += ", low: " + number_text(bound.low);
    if (std::isfinite(bound.high)) text += ", high: " + number_text(bound.high);
    text += "}\n";
  }
  return text;
}

}  // namespace tumble::scenarios
