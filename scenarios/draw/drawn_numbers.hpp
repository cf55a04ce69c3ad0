// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// DrawnNumber is a parameter of the scenario whose value depends on the seed.
struct DrawnNumber {
  std::string place;  ///< name of the random stream: "world.slope_rad", "sensors.imu.mount_error.x_m"
  Distribution distribution;
  /// Draws the value with `seed`, without building the situation.
  double of(std::uint64_t seed) const { return draw_number(distribution, seed, place); }
};

/// Returns all random parameters of the scenario, in the order of the scenario file.
std::vector<DrawnNumber> drawn_numbers(const Scenario& scenario);

}  // namespace tumble::scenarios
