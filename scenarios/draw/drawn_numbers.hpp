// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

/// A number of a scenario that differs from draw to draw.
struct DrawnNumber {
  std::string place;  ///< "world.slope_rad", "sensors.imu.mount_error.x_m": the name of its stream
  Distribution distribution;
  /// As draw `seed` has it, without the draw being resolved or simulated.
  double of(std::uint64_t seed) const { return draw_number(distribution, seed, place); }
};

/// All of them, in the order of the file's parts; what is constant is left out.
std::vector<DrawnNumber> drawn_numbers(const Scenario& scenario);

}  // namespace tumble::scenarios
