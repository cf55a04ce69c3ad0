// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

Registry Registry::of_simulation() {
  return {sim::world_types(), sim::robot_types(), sim::motion_types(), sim::sensor_types(),
          sim::mount_error_parameters()};
}

sim::ResolvedSituation draw(const DataRoot& data, const Scenario& scenario, std::uint64_t seed) {
  std::vector<DataSheet> sheets;
  for (const Scenario::Sensor& sensor : scenario.sensors) {
    const auto of_the_same = std::find_if(sheets.begin(), sheets.end(),
                                          [&](const DataSheet& sheet) { return sheet.device == sensor.device; });
    if (of_the_same != sheets.end()) {
      sheets.push_back(DataSheet(*of_the_same));
      continue;
    }
    try {
      sheets.push_back(load_data_sheet(data, sensor.device));
    } catch (const BadInput& error) {
      throw BadInput(scenario.file + ":" + std::to_string(sensor.line) + ": sensors." + sensor.name + ": " +
                     error.what());
    }
  }
  const sim::Situation given = draw_given(scenario, sheets, seed);
  try {
    return sim::resolve(given);
  } catch (const sim::InvalidSituation& error) {
    throw BadInput(scenario.file + ": simulated run with seed " + std::to_string(seed) + ": " + error.what());
  }
}

namespace {

void draw_numbers(const std::map<std::string, Distribution>& numbers, std::uint64_t seed, const std::string& place,
                  sim::Values& out) {
  for (const auto& [name, distribution] : numbers) out.set(name, draw_number(distribution, seed, place + "." + name));
}

sim::Component draw_part(const Scenario::Part& part, std::uint64_t seed, const std::string& place) {
  sim::Component out{part.type, {}};
  draw_numbers(part.numbers, seed, place, out.values);
  return out;
}

sim::SensorSpec draw_sensor(const Scenario::Sensor& sensor, const DataSheet& sheet, std::uint64_t seed) {
  const std::string place = "sensors." + sensor.name;
  sim::SensorSpec out{sensor.name, sensor.kind, sensor.device, sensor.site, sheet.values(), {}};
  draw_numbers(sensor.numbers, seed, place, out.values);
  draw_numbers(sensor.mount_error, seed, place + ".mount_error", out.mount_error);
  return out;
}

}  // namespace

sim::Situation draw_given(const Scenario& scenario, std::span<const DataSheet> sheets, std::uint64_t seed) {
  sim::Situation out;
  out.scenario = scenario.name;
  out.seed = seed;
  out.streams = scenario.streams;
  out.duration_s = draw_number(scenario.duration_s, seed, "duration_s");
  out.world = draw_part(scenario.world, seed, "world");
  out.robot = draw_part(scenario.robot, seed, "robot");
  out.motion = draw_part(scenario.motion, seed, "motion");
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    const Scenario::Sensor& sensor = scenario.sensors[i];
    if (sheets[i].sensor_kind != sensor.kind) {
      throw BadInput(fmt::format("{}:{}: sensors.{}: the device '{}' is a sensor of kind '{}'; it must be of kind '{}'",
                                 scenario.file, sensor.line, sensor.name, sensor.device, sheets[i].sensor_kind,
                                 sensor.kind));
    }
    out.sensors.push_back(draw_sensor(sensor, sheets[i], seed));
  }
  return out;
}

}  // namespace tumble::scenarios
