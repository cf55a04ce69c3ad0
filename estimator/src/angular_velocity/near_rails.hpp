// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Finds readings that may have been saturated for a part of their averaging window, see rails.md (R76). Cost: O(N).
/// Bit j of a sample is set if |saturation level - reading| < |reading - neighbouring reading| for element j. Within 3
/// % of the saturation level, the two nearest readings on each side count as neighbours. Repeated readings count once.
/// All bits are zero for a sign whose saturation level was never observed.
std::vector<std::uint8_t> possible_partial_saturation(std::span<const ImuSample> samples, const RailPlanes& planes);

/// Tests one reading against the readings before and after it (null at the ends). Cost: O(1).
std::uint8_t possible_partial_saturation(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                                         const RailPlanes& planes);

}  // namespace tumble
