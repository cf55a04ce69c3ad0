// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// steady_stamps restores time stamps that were rounded to steps longer than the sample period.
namespace tumble::scenarios {

/// StampBounds states how far the true time may be before and after a time stamp.
struct StampBounds {
  std::int64_t before_ns = 0, after_ns = 0;
};

/// Returns regular time stamps for a series of samples. Each time stamp is moved, within its bounds, to a line through
/// ten neighbours on either side, up to the next gap. A gap is a step above 1.3 times the median step plus the bounds
/// of both time stamps. The period is assumed constant over twenty samples; jitter beyond the bounds remains. `bounds`
/// is parallel to `stamps_ns`, which must not decrease. The cost is O(N).
std::vector<std::int64_t> steady_stamps(std::span<const std::int64_t> stamps_ns, std::span<const StampBounds> bounds);

}  // namespace tumble::scenarios
