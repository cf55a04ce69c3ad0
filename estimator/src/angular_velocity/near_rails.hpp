// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Finds readings that may have been saturated for a part of their window. Cost: O(N). Bit j of a sample is set if the
/// reading of the gyro's sensing element j is unsaturated, but not certainly a full measurement. A reading is suspect
/// if its distance below the saturation level is smaller than its larger step to a neighbour. Within 3 % of the
/// saturation level, the largest step within two readings replaces the step to a neighbour, see rails.md (R76). Sides
/// without an observed saturation level are excluded, so that all bits are zero without clipping. Repeated readings
/// count once.
std::vector<std::uint8_t> possible_partial_saturation(std::span<const ImuSample> samples, const RailPlanes& planes);

/// Checks one reading of a stream, from the steps to its neighbours (null at the ends). Cost: O(1).
std::uint8_t possible_partial_saturation(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                                         const RailPlanes& planes);

}  // namespace tumble
