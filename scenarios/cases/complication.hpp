// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Removable detail of a simulated run: a sensor error, stones, a spin. A complication consists of numbers of the
/// scenario and their ideal values.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< place (fixed_number.hpp) and ideal value of the numbers
                                                        ///< that are not ideal
  std::optional<double> amount;                         ///< value of a single number that can also be reduced
  bool whole = false;                                   ///< the amount is a count
};

/// Returns what can be simplified in a scenario with fixed numbers (fixed_scenario.hpp), ordered by part: world, robot,
/// motion, then each sensor's errors. Related complications are adjacent in the list. Each complication is registered
/// by one line of complication.cpp. Numbers that are already ideal are omitted.
std::vector<Complication> complications(const Scenario& scenario);

/// Sets the numbers of this complication to their ideal values in the scenario.
void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
