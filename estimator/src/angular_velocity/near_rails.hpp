// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Bit j of each sample: the reading of the gyro's element j is free, but its window may have met the rail in a part of
/// its length, so that nobody can say it was measured. Such a reading lies short of the rail by less than its larger
/// step to the readings beside it or, within 3 % of the rail, by less than the largest within two of it: rails.md
/// (R76). Nothing for sides of an element whose rail was not seen, hence nothing at all where nothing clips. Readings
/// that are said twice count once. O(N).
std::vector<std::uint8_t> may_meet_rails(std::span<const ImuSample> samples, const RailPlanes& planes);

/// Of one reading, by the steps to those beside it alone, null where there is none: as a stream has them. O(1).
std::uint8_t may_meet_rails(const ImuSample* before, const ImuSample& now, const ImuSample* after,
                            const RailPlanes& planes);

}  // namespace tumble
