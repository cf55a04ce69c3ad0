// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/draw/case_text.hpp"
#include "scenarios/draw/drawn_numbers.hpp"
#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

namespace {

using Shape = Distribution::Shape;
using Numbers = std::map<std::string, Distribution>;

constexpr double kLongestDuration_s = 3600.0;
constexpr sim::Parameter kDuration{"duration_s", 10.0, 0.01, kLongestDuration_s, "s", "duration of the scenario"};

Distribution parse_distribution(const YamlNode& node) {
  static const std::array<std::string, 4> kShapes = {"uniform", "normal", "log_uniform", "choice"};
  Distribution out;
  out.line = node.line();
  if (node.is_scalar()) {
    out.numbers = {node.number()};
    return out;
  }
  if (!node.is_map())
    node.fail("the value must be a number or one of the distributions {uniform|normal|log_uniform|choice: [...]}");
  const auto entries = node.entries();
  if (entries.size() != 1)
    node.fail("the distribution must have exactly one of the keys uniform, normal, log_uniform, choice");
  const auto& [name, values] = entries[0];
  const auto shape = std::find(kShapes.begin(), kShapes.end(), name);
  if (shape == kShapes.end()) values.fail("unknown distribution '" + name + "'" + suggestion(name, kShapes));
  constexpr std::array<Shape, 4> kOrder = {Shape::uniform, Shape::normal, Shape::log_uniform, Shape::choice};
  out.shape = kOrder[static_cast<std::size_t>(shape - kShapes.begin())];
  for (const YamlNode& item : values.items()) out.numbers.push_back(item.number());
  return out;
}

Distribution parse_checked(const YamlNode& node, const sim::Parameter& parameter) {
  const Distribution out = parse_distribution(node);
  const std::string problem = find_problem(out);
  if (!problem.empty()) node.fail(problem);
  for (const double point : support_points(out)) {
    if (point >= parameter.low && point <= parameter.high) continue;
    node.fail(fmt::format("the value of this parameter {} {:g} {}; it must be within [{:g}, {:g}]",
                          out.shape == Shape::constant ? "is" : "can reach", point, parameter.unit, parameter.low,
                          parameter.high));
  }
  return out;
}

Numbers parse_numbers(const YamlNode& map, std::span<const std::string> other, std::span<const sim::Parameter> known) {
  Numbers out;
  for (const auto& [name, value] : map.entries()) {
    if (std::find(other.begin(), other.end(), name) != other.end()) continue;
    const sim::Parameter* const parameter = find_parameter(known, name);
    if (parameter == nullptr) {
      std::vector<std::string> names = names_of(known);
      names.insert(names.end(), other.begin(), other.end());
      value.fail("unknown key '" + name + "'" + suggestion(name, names));
    }
    out.emplace(name, parse_checked(value, *parameter));
  }
  return out;
}

const YamlNode* find_entry(const std::vector<std::pair<std::string, YamlNode>>& entries, const std::string& name) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const auto& entry) { return entry.first == name; });
  return found == entries.end() ? nullptr : &found->second;
}

const sim::ComponentType& known_type(const YamlNode& node, std::span<const sim::ComponentType> types) {
  const std::string name = node.identifier();
  const sim::ComponentType* const type = find_type(types, name);
  if (type == nullptr) node.fail("unknown '" + name + "'" + suggestion(name, names_of(types)));
  return *type;
}

Scenario::Part parse_part(const YamlNode& node, std::span<const sim::ComponentType> types) {
  static const std::array<std::string, 1> kOther = {"type"};
  const auto entries = node.entries();
  const YamlNode* const type_node = find_entry(entries, "type");
  if (type_node == nullptr) node.fail("key 'type' is missing");
  const sim::ComponentType& type = known_type(*type_node, types);
  return {type.name, parse_numbers(node, kOther, type.parameters), node.line()};
}

Scenario::Sensor parse_sensor(const YamlNode& node, const Registry& registry) {
  static const std::array<std::string, 5> kOther = {"name", "kind", "device", "site", "mount_error"};
  const auto entries = node.entries();
  for (const char* required : {"name", "kind", "device", "site"}) {
    if (find_entry(entries, required) == nullptr) node.fail(fmt::format("key '{}' is missing", required));
  }
  const sim::ComponentType& type = known_type(*find_entry(entries, "kind"), registry.sensors);
  Scenario::Sensor out;
  out.line = node.line();
  out.name = find_entry(entries, "name")->identifier();
  out.kind = type.name;
  out.device = find_entry(entries, "device")->identifier();
  out.site = find_entry(entries, "site")->identifier();
  out.numbers = parse_numbers(node, kOther, type.parameters);
  if (const YamlNode* const error = find_entry(entries, "mount_error")) {
    out.mount_error = parse_numbers(*error, {}, registry.mount_error);
  }
  return out;
}

std::vector<Scenario::Sensor> parse_sensors(const YamlNode& list, const Registry& registry) {
  std::vector<Scenario::Sensor> out;
  for (const YamlNode& item : list.items()) {
    Scenario::Sensor sensor = parse_sensor(item, registry);
    for (const Scenario::Sensor& other : out) {
      if (other.name == sensor.name)
        item.fail(fmt::format("a sensor with the name '{}' exists already in line {}; choose another name", sensor.name,
                              other.line));
    }
    out.push_back(std::move(sensor));
  }
  if (out.empty()) list.fail("the scenario needs at least one sensor");
  return out;
}

std::map<std::string, std::uint64_t> parse_streams(const YamlNode& node, std::span<const Scenario::Sensor> sensors) {
  std::vector<std::string> known = {sim::kWorldStream};
  for (const Scenario::Sensor& sensor : sensors) known.push_back(sensor.name);
  std::map<std::string, std::uint64_t> out;
  for (const auto& [name, seed] : node.entries()) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      seed.fail(fmt::format("unknown random stream '{}'{}", name, suggestion(name, known)));
    out[name] = seed.unsigned_integer();
  }
  return out;
}

}  // namespace

const sim::Parameter& duration_parameter() {
  return kDuration;
}

Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry) {
  static const std::array<std::string, 7> kKeys = {"name", "doc", "duration_s", "world", "robot", "motion", "sensors"};
  static const std::array<std::string, 2> kOptional = {"case", "streams"};
  const auto fields = YamlNode::parse(text, file).fields(kKeys, kOptional);
  Scenario out;
  out.file = file;
  out.name = fields.at("name").identifier();
  out.doc = fields.at("doc").text();
  out.duration_s = parse_checked(fields.at("duration_s"), kDuration);
  out.world = parse_part(fields.at("world"), registry.worlds);
  out.robot = parse_part(fields.at("robot"), registry.robots);
  out.motion = parse_part(fields.at("motion"), registry.motions);
  out.sensors = parse_sensors(fields.at("sensors"), registry);
  if (fields.contains("streams")) out.streams = parse_streams(fields.at("streams"), out.sensors);
  if (fields.contains("case")) {
    out.named_case = case_from_yaml(fields.at("case"));
    const std::vector<DrawnNumber> drawn = drawn_numbers(out);
    if (!drawn.empty())
      fields.at("case").fail(
          fmt::format("a named case describes one simulated run, but its number {} is random; give a constant",
                      drawn.front().place));
  }
  return out;
}

}  // namespace tumble::scenarios
