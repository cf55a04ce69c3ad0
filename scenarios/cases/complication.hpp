// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Complication is a removable detail of a simulated run, for example a sensor error, stones or a spin. A complication
/// consists of numbers of the scenario and their ideal values.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< place (fixed_number.hpp) and ideal value
  std::optional<double> amount;                         ///< value of a single number that can be reduced
  bool whole = false;                                   ///< the amount is a count
};

/// Returns all removable details of a scenario with fixed numbers (fixed_scenario.hpp). The order of the complications
/// is world, robot, motion, then each sensor's errors. Related complications are adjacent in the list. Each
/// complication is registered by one line of complication.cpp. Complications whose numbers are all ideal are omitted.
std::vector<Complication> complications(const Scenario& scenario);

/// Sets the numbers of this complication in the scenario to their ideal values.
void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
