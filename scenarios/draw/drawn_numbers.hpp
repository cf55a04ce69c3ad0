// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {

struct DrawnNumber {
  std::string place;  ///< name of the random stream: "world.slope_rad", "sensors.imu.mount_error.x_m"
  Distribution distribution;
  double of(std::uint64_t seed) const { return draw_number(distribution, seed, place); }
};

std::vector<DrawnNumber> drawn_numbers(const Scenario& scenario);

}  // namespace tumble::scenarios
