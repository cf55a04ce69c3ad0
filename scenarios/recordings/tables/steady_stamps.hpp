// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// steady_stamps.hpp restores stamps that were rounded to a raster coarser than the sample period. Used only within
/// scenarios/recordings.
namespace tumble::scenarios {

/// StampBounds contains the limits of the true time before and after a stamp.
struct StampBounds {
  std::int64_t before_ns = 0, after_ns = 0;
};

/// Regularises the time stamps of a series. Each stamp moves to a line through ten neighbours on either side in its
/// segment, limited by the stamp's bounds. A gap is a step longer than 1.3 times the median step plus the width of both
/// stamps' bounds. The method assumes a constant period over twenty samples; jitter larger than the bounds remains.
/// `bounds` is parallel to `stamps_ns`, which must not decrease. Cost: O(N).
std::vector<std::int64_t> steady_stamps(std::span<const std::int64_t> stamps_ns, std::span<const StampBounds> bounds);

}  // namespace tumble::scenarios
