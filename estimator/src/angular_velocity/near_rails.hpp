// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Finds readings that may have been saturated for a part of their window. Bit j of a sample is set if the reading of
/// sensing element j of the gyro is unsaturated, but not certainly a full measurement. A reading is suspect if it is
/// below the saturation level by less than its larger step to its neighbours. Within 3 % of the saturation level, the
/// largest step within two readings counts: rails.md (R76). Sides without an observed saturation level are excluded, so
/// nothing is returned without clipping. Repeated readings count once. Cost: O(N).
std::vector<std::uint8_t> may_meet_rails(std::span<const ImuSample> samples, const RailPlanes& planes);

/// Checks one reading of a stream, from the steps to its neighbours (null at the ends). Cost: O(1).
std::uint8_t may_meet_rails(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                            const RailPlanes& planes);

}  // namespace tumble
