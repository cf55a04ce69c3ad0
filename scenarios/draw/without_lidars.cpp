// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/without_lidars.hpp"

#include <vector>

namespace tumble::scenarios {

sim::Situation without_lidars(sim::Situation situation) {
  std::erase_if(situation.sensors, [](const sim::SensorSpec& sensor) { return sensor.kind.ends_with("_lidar"); });
  return situation;
}

}  // namespace tumble::scenarios
