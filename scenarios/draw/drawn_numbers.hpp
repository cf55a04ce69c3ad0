// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// DrawnNumber is a number of the scenario that depends on the random seed.
struct DrawnNumber {
  std::string place;  ///< stream name: "world.slope_rad", "sensors.imu.mount_error.x_m"
  Distribution distribution;
  /// Draws the number with `seed`, without resolving or simulating the scenario.
  double of(std::uint64_t seed) const { return draw_number(distribution, seed, place); }
};

/// Returns all random numbers of the scenario, in the order of the scenario file.
std::vector<DrawnNumber> drawn_numbers(const Scenario& scenario);

}  // namespace tumble::scenarios
