// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_text.hpp"

namespace tumble::scenarios {

namespace {

std::string values_text(const sim::Values& values, const std::string& indent, const std::string& place) {
  std::string out;
  for (const auto& [name, value] : values.all()) {
    out += indent + yaml_word(name) + ": " + yaml_number(value, place + "." + name) + "\n";
  }
  return out;
}

std::string component_text(const std::string& name, const sim::Component& component) {
  const std::string values = values_text(component.values, "    ", name);
  return name + ":\n  type: " + yaml_word(component.type) + "\n  values:" + (values.empty() ? " {}\n" : "\n" + values);
}

std::string sensor_text(const sim::SensorSpec& sensor) {
  const std::string place = "sensors." + sensor.name;
  const std::string values = values_text(sensor.values, "      ", place);
  const std::string error = values_text(sensor.mount_error, "      ", place + ".mount_error");
  return "  - name: " + yaml_word(sensor.name) + "\n    kind: " + yaml_word(sensor.kind) +
         "\n    device: " + yaml_word(sensor.device) + "\n    site: " + yaml_word(sensor.site) +
         "\n    values:" + (values.empty() ? " {}\n" : "\n" + values) +
         "    mount_error:" + (error.empty() ? " {}\n" : "\n" + error);
}

sim::Values values_from(const YamlNode& node) {
  sim::Values out;
  for (const auto& [name, value] : node.entries()) out.set(name, value.number_or_infinity());
  return out;
}

sim::Component component_from(const YamlNode& node) {
  static const std::array<std::string, 2> kKeys = {"type", "values"};
  const auto fields = node.fields(kKeys);
  return {fields.at("type").any_text(), values_from(fields.at("values"))};
}

sim::SensorSpec sensor_from(const YamlNode& node) {
  static const std::array<std::string, 6> kKeys = {"name", "kind", "device", "site", "values", "mount_error"};
  const auto fields = node.fields(kKeys);
  return {fields.at("name").any_text(), fields.at("kind").any_text(),     fields.at("device").any_text(),
          fields.at("site").any_text(), values_from(fields.at("values")), values_from(fields.at("mount_error"))};
}

}  // namespace

std::string to_yaml(const sim::Situation& situation) {
  std::string out = "scenario: " + yaml_word(situation.scenario) + "\nseed: " + std::to_string(situation.seed) +
                    "\nduration_s: " + yaml_number(situation.duration_s, "duration_s") + "\n";
  out += component_text("world", situation.world);
  out += component_text("robot", situation.robot);
  out += component_text("motion", situation.motion);
  out += situation.sensors.empty() ? "sensors: []\n" : "sensors:\n";
  for (const sim::SensorSpec& sensor : situation.sensors) out += sensor_text(sensor);
  return out + streams_text(situation.streams);
}

sim::Situation situation_from_yaml(const std::string& text, const std::string& place) {
  static const std::array<std::string, 7> kKeys = {"scenario", "seed",   "duration_s", "world",
                                                   "robot",    "motion", "sensors"};
  static const std::array<std::string, 1> kOptional = {"streams"};
  const auto fields = YamlNode::parse(text, place).fields(kKeys, kOptional);
  sim::Situation out;
  out.scenario = fields.at("scenario").any_text();
  out.seed = fields.at("seed").unsigned_integer();
  out.duration_s = fields.at("duration_s").number();
  out.world = component_from(fields.at("world"));
  out.robot = component_from(fields.at("robot"));
  out.motion = component_from(fields.at("motion"));
  for (const YamlNode& sensor : fields.at("sensors").items()) out.sensors.push_back(sensor_from(sensor));
  if (!fields.contains("streams")) return out;
  for (const auto& [name, seed] : fields.at("streams").entries()) out.streams[name] = seed.unsigned_integer();
  return out;
}

}  // namespace tumble::scenarios
