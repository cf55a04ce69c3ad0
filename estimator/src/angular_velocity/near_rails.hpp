// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Finds readings that may have been saturated for a part of their averaging window. Cost: O(N). Bit j of a sample is
/// set if gyro element j is unsaturated but may have been saturated for a part of the window. A reading is suspect if
/// it is closer to the saturation level than to one of its neighbours. Within 3 % of the saturation level, the function
/// uses the largest step to two readings on each side, see rails.md (R76). All bits are zero for a sign whose
/// saturation level was never observed. A repeated reading counts once.
std::vector<std::uint8_t> possible_partial_saturation(std::span<const ImuSample> samples, const RailPlanes& planes);

/// Checks one reading by the steps to the readings before and after it (null at the ends). Cost: O(1).
std::uint8_t possible_partial_saturation(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                                         const RailPlanes& planes);

}  // namespace tumble
