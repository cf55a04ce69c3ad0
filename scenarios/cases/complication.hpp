// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Complication is a removable detail of a simulated run, for example a sensor error, stones on the floor or a spin:
/// scenario parameters, each with the ideal value that removes the detail.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< parameter name (fixed_number.hpp) and ideal value
  std::optional<double> amount;                         ///< value of a single parameter that can be reduced
  bool whole = false;                                   ///< `amount` is an integer count
};

/// Returns all removable details of a scenario with constant parameters, in the order world, robot, motion, errors of
/// each sensor. Details whose parameters are already ideal are omitted.
std::vector<Complication> complications(const Scenario& scenario);

void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
