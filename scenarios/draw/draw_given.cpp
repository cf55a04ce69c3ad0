// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario_text.hpp"

#include <fmt/format.h>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

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
