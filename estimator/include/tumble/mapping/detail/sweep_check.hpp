// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"
#include "tumble/mapping/deskew.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble::mapping {

/// `out_of_range` when a point was fired after the sweep's end.
Status check_offsets(TimeNs span_ns, std::span<const LidarPoint> points);

/// What makes a sweep useless: `empty` (no points), `non_finite` (no finite point), `too_few` (none in range),
/// `degenerate` (all points bear one time stamp though the sweep lasts: a driver that lost its time stamps, nothing
/// could be deskewed, and nothing would show it).
Status check_selection(TimeNs span_ns, std::span<const LidarPoint> points, const PointCounts& counts);

}  // namespace tumble::mapping
