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

using Entries = std::vector<std::pair<std::string, YamlNode>>;

const sim::ComponentType& parse_type(const YamlNode& node, const Entries& entries, const std::string& key,
                                     std::span<const sim::ComponentType> types, const std::string& base) {
  if (const YamlNode* const own = find_entry(entries, key)) return known_type(*own, types);
  if (base.empty()) node.fail(fmt::format("key '{}' is missing", key));
  return *find_type(types, base);
}

/// If a YAML node has no key `type`, numbers that the YAML node omits keep the values of the base scenario.
void parse_part(const YamlNode& node, std::span<const sim::ComponentType> types, Scenario::Part& part) {
  static const std::array<std::string, 1> kOther = {"type"};
  const Entries entries = node.entries();
  const sim::ComponentType& type = parse_type(node, entries, "type", types, part.type);
  Numbers numbers = parse_numbers(node, kOther, type.parameters);
  if (find_entry(entries, "type") == nullptr) numbers.merge(part.numbers);
  part = {type.name, std::move(numbers), node.line()};
}

/// If the YAML node of a sensor has no key `kind`, omitted values come from the sensor `base` of the base scenario.
Scenario::Sensor parse_sensor(const YamlNode& node, const Registry& registry, Scenario::Sensor base) {
  static const std::array<std::string, 5> kOther = {"name", "kind", "device", "site", "mount_error"};
  const Entries entries = node.entries();
  if (find_entry(entries, "kind") != nullptr) base = {};
  const auto read = [&](const std::string& key, const std::string& inherited) {
    if (const YamlNode* const own = find_entry(entries, key)) return own->identifier();
    if (inherited.empty()) node.fail(fmt::format("key '{}' is missing", key));
    return inherited;
  };
  Scenario::Sensor out;
  out.line = node.line();
  out.name = read("name", base.name);
  const sim::ComponentType& type = parse_type(node, entries, "kind", registry.sensors, base.kind);
  out.kind = type.name;
  out.device = read("device", base.device);
  out.site = read("site", base.site);
  out.numbers = parse_numbers(node, kOther, type.parameters);
  out.numbers.merge(base.numbers);
  if (const YamlNode* const error = find_entry(entries, "mount_error"))
    out.mount_error = parse_numbers(*error, {}, registry.mount_error);
  out.mount_error.merge(base.mount_error);
  return out;
}

void parse_sensors(const YamlNode& list, const Registry& registry, std::vector<Scenario::Sensor>& sensors) {
  std::map<std::string, int> lines;
  for (const YamlNode& item : list.items()) {
    const Entries entries = item.entries();
    const YamlNode* const name = find_entry(entries, "name");
    auto place = std::find_if(sensors.begin(), sensors.end(), [&](const Scenario::Sensor& sensor) {
      return name != nullptr && sensor.name == name->any_text();
    });
    Scenario::Sensor sensor = parse_sensor(item, registry, place != sensors.end() ? *place : Scenario::Sensor{});
    const auto [other, is_new] = lines.emplace(sensor.name, sensor.line);
    if (!is_new)
      item.fail(fmt::format("a sensor with the name '{}' exists already in line {}; choose another name", sensor.name,
                            other->second));
    if (place == sensors.end()) place = sensors.emplace(place);
    *place = std::move(sensor);
  }
  if (sensors.empty()) list.fail("the scenario needs at least one sensor");
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

Scenario refuse_base(const YamlNode& extends) {
  extends.fail("the key 'extends' is allowed only in a scenario file; remove the key");
}

Scenario parse_scenario(const std::string& text, const std::string& file, const Registry& registry,
                        const LoadBase& load_base) {
  static const std::vector<std::string> kParts = {"duration_s", "world", "robot", "motion", "sensors"};
  std::vector<std::string> required = {"name", "doc"}, optional = {"case", "streams", "extends"};
  const YamlNode document = YamlNode::parse(text, file);
  const bool extends = document.is_map() && find_entry(document.entries(), "extends") != nullptr;
  std::vector<std::string>& with_parts = extends ? optional : required;
  with_parts.insert(with_parts.end(), kParts.begin(), kParts.end());
  const auto fields = document.fields(required, optional);
  Scenario out;
  if (extends) {
    out = load_base(fields.at("extends"));
    out.named_case.reset();
    const int line = fields.at("extends").line();  // messages about inherited sensors name this line
    for (Scenario::Sensor& sensor : out.sensors) sensor.line = line;
  }
  out.file = file;
  out.name = fields.at("name").identifier();
  out.doc = fields.at("doc").text();
  if (fields.contains("duration_s")) out.duration_s = parse_checked(fields.at("duration_s"), kDuration);
  if (fields.contains("world")) parse_part(fields.at("world"), registry.worlds, out.world);
  if (fields.contains("robot")) parse_part(fields.at("robot"), registry.robots, out.robot);
  if (fields.contains("motion")) parse_part(fields.at("motion"), registry.motions, out.motion);
  if (fields.contains("sensors")) parse_sensors(fields.at("sensors"), registry, out.sensors);
  if (fields.contains("streams")) out.streams = parse_streams(fields.at("streams"), out.sensors);
  if (fields.contains("case")) {
    out.named_case = case_from_yaml(fields.at("case"));
    const std::vector<DrawnNumber> drawn = drawn_numbers(out);
    if (!drawn.empty())
      fields.at("case").fail(
          fmt::format("the number {} is random, but all numbers of a named case must be constant, because a named case "
                      "describes one simulated run",
                      drawn.front().place));
  }
  return out;
}

}  // namespace tumble::scenarios
