// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/without_lidars.hpp"

namespace tumble::scenarios {

sim::ResolvedSituation without_lidars(const sim::ResolvedSituation& situation) {
  return situation.without_sensors([](const sim::SensorSpec& sensor) { return sensor.kind.ends_with("_lidar"); });
}

}  // namespace tumble::scenarios
