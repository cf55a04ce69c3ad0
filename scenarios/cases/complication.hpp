// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Complication is a removable detail of a simulated run, for example a sensor error, stones on the floor or a spin. A
/// complication consists of numbers of the scenario, each with its ideal value.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< place (fixed_number.hpp) and ideal value
  std::optional<double> amount;                         ///< value of a single number that can be reduced
  bool whole = false;                                   ///< the amount is a count
};

/// Returns all complications of a scenario with fixed numbers (fixed_scenario.hpp). The list starts with the world, the
/// robot and the motion, then contains the errors of each sensor. Related complications are adjacent in the list. Each
/// complication has one line in a table of complication.cpp. A complication is omitted if all of its numbers are ideal.
std::vector<Complication> complications(const Scenario& scenario);

/// Sets the numbers of this complication in the scenario to their ideal values.
void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
