// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// Stamps that stand on a coarser raster than the beat they belong to. Private to scenarios/recordings.
namespace tumble::scenarios {

/// How far the true instant may lie before and after a stamp.
struct StampBounds {
  std::int64_t before_ns = 0, after_ns = 0;
};

/// The stamps put on a steady beat: each on the straight line through its neighbours, ten on either side in the same
/// piece without a gap, and within its bounds of where it stood. A gap is a step longer than 1.3 times the median and
/// the width of both bounds. Assumes a beat that is steady over twenty samples; what jitters by more than the bounds
/// keeps its jitter. `bounds` is parallel to `stamps_ns`, which must not fall. O(N).
std::vector<std::int64_t> steady_stamps(std::span<const std::int64_t> stamps_ns, std::span<const StampBounds> bounds);

}  // namespace tumble::scenarios
