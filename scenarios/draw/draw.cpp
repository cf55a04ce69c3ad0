// SPDX-License-Identifier: BSD-3-Clause
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

}  // namespace tumble::scenarios
