// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Complication is one detail of a simulated run that can be removed, for example a sensor error, stones on the floor
/// or a spin.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< parameter and its ideal value
  std::optional<double> amount;                         ///< for a single reducible parameter
  bool whole = false;                                   ///< `amount` is an integer count
};

/// Returns all details of a scenario that can be removed to simplify the scenario.
std::vector<Complication> complications(const Scenario& scenario);

void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
