// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/without_lidars.hpp"

#include <algorithm>

namespace tumble::scenarios {

namespace {

bool is_lidar(const std::string& kind) {
  return kind.ends_with("_lidar");
}

}  // namespace

bool has_lidar(const Scenario& scenario) {
  return std::any_of(scenario.sensors.begin(), scenario.sensors.end(),
                     [](const Scenario::Sensor& sensor) { return is_lidar(sensor.kind); });
}

sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation) {
  return situation.without_sensors([](const sim::SensorSpec& sensor) { return is_lidar(sensor.kind); });
}

}  // namespace tumble::scenarios
