// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// Something that a draw could do without: an error of a sensor, stones, a spin. Numbers of the scenario, and what they
/// are where it is not there.
struct Complication {
  std::string name;                                     ///< "sensors.imu: white noise", "world: rocks"
  std::vector<std::pair<std::string, double>> without;  ///< place (fixed_number.hpp) and value, of those not so yet
  std::optional<double> amount;                         ///< of a single number that may also be made smaller
  bool whole = false;                                   ///< the amount is a count
};

/// What can be simpler in a scenario whose numbers are all fixed (fixed_scenario.hpp), by parts of the scenario, what
/// belongs together side by side: world, robot, motion, then each sensor's errors. One line of registration each
/// (complication.cpp). What is ideal already is left out.
std::vector<Complication> complications(const Scenario& scenario);

/// The scenario without this complication.
void take_away(const Complication& complication, Scenario& scenario);

}  // namespace tumble::scenarios
