// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/drawn_numbers.hpp"

namespace tumble::scenarios {

namespace {

void add(const std::string& place, const Distribution& distribution, std::vector<DrawnNumber>& out) {
  if (distribution.shape != Distribution::Shape::constant) out.push_back({place, distribution});
}

void add(const std::string& place, const std::map<std::string, Distribution>& numbers, std::vector<DrawnNumber>& out) {
  for (const auto& [name, distribution] : numbers) add(place + "." + name, distribution, out);
}

}  // namespace

std::vector<DrawnNumber> drawn_numbers(const Scenario& scenario) {
  std::vector<DrawnNumber> out;
  add("duration_s", scenario.duration_s, out);
  add("world", scenario.world.numbers, out);
  add("robot", scenario.robot.numbers, out);
  add("motion", scenario.motion.numbers, out);
  for (const Scenario::Sensor& sensor : scenario.sensors) {
    const std::string place = "sensors." + sensor.name;
    add(place, sensor.numbers, out);
    add(place + ".mount_error", sensor.mount_error, out);
  }
  return out;
}

}  // namespace tumble::scenarios
