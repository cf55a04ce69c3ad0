// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/fixed_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenarios/draw/case_text.hpp"
#include "scenarios/draw/drawn_numbers.hpp"
#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_text.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

using Numbers = std::map<std::string, Distribution>;

Distribution constant(double value) {
  return {Distribution::Shape::constant, {value}, 0};
}

void fix(const sim::Values& values, Numbers& numbers) {
  for (const auto& [name, value] : values.all()) numbers[name] = constant(value);
}

std::vector<std::string> entries_of(const Numbers& numbers, const std::string& place) {
  std::vector<std::string> out;
  for (const auto& [name, number] : numbers)
    out.push_back(name + ": " + yaml_number(number.numbers.front(), place + "." + name));
  return out;
}

std::string map_text(const std::string& start, const std::vector<std::string>& entries, const std::string& indent) {
  constexpr std::size_t kColumns = 120;
  std::string out, line = start + "{";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string entry = entries[i] + (i + 1 < entries.size() ? "," : "}");
    if (line.size() + 1 + entry.size() > kColumns) {
      out += line + "\n";
      line = indent + entry;
    } else {
      line += (i > 0 ? " " : "") + entry;
    }
  }
  return out + line + "\n";
}

std::string part_text(const std::string& place, const Scenario::Part& part) {
  std::vector<std::string> entries = entries_of(part.numbers, place);
  entries.insert(entries.begin(), "type: " + yaml_word(part.type));
  return map_text(place + ": ", entries, "  ");
}

std::string sensor_text(const Scenario::Sensor& sensor) {
  const std::string place = "sensors." + sensor.name;
  std::vector<std::string> entries = {"name: " + yaml_word(sensor.name), "kind: " + yaml_word(sensor.kind),
                                      "device: " + yaml_word(sensor.device), "site: " + yaml_word(sensor.site)};
  for (const std::string& number : entries_of(sensor.numbers, place)) entries.push_back(number);
  std::vector<std::string> errors = entries_of(sensor.mount_error, place + ".mount_error");
  if (!errors.empty()) {
    errors.front() = "mount_error: {" + errors.front();
    errors.back() += "}";
  }
  entries.insert(entries.end(), errors.begin(), errors.end());
  return map_text("  - ", entries, "     ");
}

}  // namespace

Scenario fixed_as(Scenario scenario, const sim::Situation& situation) {
  scenario.duration_s = constant(situation.duration_s);
  fix(situation.world.values, scenario.world.numbers);
  fix(situation.robot.values, scenario.robot.numbers);
  fix(situation.motion.values, scenario.motion.numbers);
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    fix(situation.sensors.at(i).values, scenario.sensors[i].numbers);
    fix(situation.sensors.at(i).mount_error, scenario.sensors[i].mount_error);
  }
  return scenario;
}

std::string to_yaml(const Scenario& scenario) {
  const std::vector<DrawnNumber> drawn = drawn_numbers(scenario);
  if (!drawn.empty())
    throw BadInput(fmt::format(
        "scenario {}: the number {} is random; it must be a constant, so that the file describes one simulated run",
        scenario.name, drawn.front().place));
  std::string out = "# SPDX-License-Identifier: BSD-3-Clause\nname: " + yaml_word(scenario.name) +
                    "\ndoc: " + yaml_word(scenario.doc) + "\n";
  if (scenario.named_case) out += to_yaml(*scenario.named_case);
  out += "duration_s: " + yaml_number(scenario.duration_s.numbers.front(), "duration_s") + "\n";
  out += part_text("world", scenario.world) + part_text("robot", scenario.robot) + part_text("motion", scenario.motion);
  out += "sensors:\n";
  for (const Scenario::Sensor& sensor : scenario.sensors) out += sensor_text(sensor);
  return out + streams_text(scenario.streams);
}

namespace {

using Numbers = std::map<std::string, Distribution>;

[[noreturn]] void fail(const Scenario& scenario, const std::string& key, const std::string& what) {
  throw BadInput("'" + key + "' of scenario " + scenario.name + ": " + what);
}

Distribution constant(const Scenario& scenario, const std::string& key, double value, const sim::Parameter& parameter) {
  if (!(value >= parameter.low && value <= parameter.high)) {
    fail(scenario, key,
         fmt::format("the new value is {:g} {}; it must be within [{:g}, {:g}]", value, parameter.unit, parameter.low,
                     parameter.high));
  }
  return {Distribution::Shape::constant, {value}, 0};
}

void fix(const Scenario& scenario, const std::string& key, const std::string& name, double value,
         std::span<const sim::Parameter> known, Numbers& numbers) {
  const sim::Parameter* const parameter = find_parameter(known, name);
  if (parameter == nullptr) fail(scenario, key, "unknown number '" + name + "'" + suggestion(name, names_of(known)));
  numbers[name] = constant(scenario, key, value, *parameter);
}

void fix(const Scenario& scenario, const std::string& key, const std::string& name, double value,
         std::span<const sim::ComponentType> types, Scenario::Part& part) {
  fix(scenario, key, name, value, find_type(types, part.type)->parameters, part.numbers);
}

void fix_of_sensor(Scenario& scenario, const std::string& key, const std::string& rest, double value,
                   const Registry& registry) {
  const std::size_t dot = rest.find('.');
  const std::string name = rest.substr(0, dot);
  std::vector<std::string> names;
  for (const Scenario::Sensor& sensor : scenario.sensors) names.push_back(sensor.name);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) fail(scenario, key, "unknown sensor '" + name + "'" + suggestion(name, names));
  if (dot == std::string::npos)
    fail(scenario, key, "the key names a sensor without a parameter; write 'sensors.SENSOR.PARAMETER'");
  Scenario::Sensor& sensor = scenario.sensors[static_cast<std::size_t>(at - names.begin())];
  const std::string number = rest.substr(dot + 1);
  const std::string mount = "mount_error.";
  if (number.starts_with(mount)) {
    fix(scenario, key, number.substr(mount.size()), value, registry.mount_error, sensor.mount_error);
  } else {
    fix(scenario, key, number, value, find_type(registry.sensors, sensor.kind)->parameters, sensor.numbers);
  }
}

}  // namespace

void fix_number(Scenario& scenario, const std::string& key, double value) {
  static const std::vector<std::string> kPlaces = {"duration_s", "world", "robot", "motion", "sensors"};
  const Registry registry = Registry::of_simulation();
  const std::size_t dot = key.find('.');
  const std::string place = key.substr(0, dot), rest = dot == std::string::npos ? "" : key.substr(dot + 1);
  if (key == "duration_s") {
    scenario.duration_s = constant(scenario, key, value, duration_parameter());
  } else if (place == "world") {
    fix(scenario, key, rest, value, registry.worlds, scenario.world);
  } else if (place == "robot") {
    fix(scenario, key, rest, value, registry.robots, scenario.robot);
  } else if (place == "motion") {
    fix(scenario, key, rest, value, registry.motions, scenario.motion);
  } else if (place == "sensors") {
    fix_of_sensor(scenario, key, rest, value, registry);
  } else {
    fail(scenario, key,
         fmt::format("the scenario has no number with the key '{}'{}", place, suggestion(place, kPlaces)));
  }
}

}  // namespace tumble::scenarios
