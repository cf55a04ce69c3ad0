// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/fixed_scenario.hpp"

#include <fmt/format.h>

#include "scenarios/draw/case_text.hpp"
#include "scenarios/draw/drawn_numbers.hpp"
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

std::string numbers_text(const Numbers& numbers, const std::string& indent, const std::string& place) {
  std::string out;
  for (const auto& [name, number] : numbers) {
    out += indent + name + ": " + yaml_number(number.numbers.front(), place + "." + name) + "\n";
  }
  return out;
}

std::string part_text(const std::string& place, const Scenario::Part& part) {
  return place + ":\n  type: " + yaml_word(part.type) + "\n" + numbers_text(part.numbers, "  ", place);
}

std::string sensor_text(const Scenario::Sensor& sensor) {
  const std::string place = "sensors." + sensor.name;
  std::string out = "  - name: " + yaml_word(sensor.name) + "\n    kind: " + yaml_word(sensor.kind) +
                    "\n    device: " + yaml_word(sensor.device) + "\n    site: " + yaml_word(sensor.site) + "\n" +
                    numbers_text(sensor.numbers, "    ", place);
  if (sensor.mount_error.empty()) return out;
  return out + "    mount_error:\n" + numbers_text(sensor.mount_error, "      ", place + ".mount_error");
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

}  // namespace tumble::scenarios
