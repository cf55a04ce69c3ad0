// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Complication is a removable detail of a simulated run, for example a sensor error, stones on the floor or a spin. A
/// complication consists of scenario parameters, each with the ideal value that removes the detail.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< parameter name (fixed_number.hpp) and ideal value
  std::optional<double> amount;                         ///< value of a single parameter that can be reduced
  bool whole = false;                                   ///< `amount` is an integer count
};

/// Returns all complications (removable details) of a scenario whose parameters are constants (fixed_scenario.hpp). The
/// order is world, robot, motion, then the errors of each sensor, so related complications are adjacent. A complication
/// is omitted if all its parameters are ideal. The tables in complication.cpp list the complications.
std::vector<Complication> complications(const Scenario& scenario);

/// Removes a complication from the scenario by setting its parameters to their ideal values.
void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
