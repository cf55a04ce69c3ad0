// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

/// Returns `out_of_range` if a point was fired after the end of the sweep, which takes `span_ns`.
Status check_time_offsets(TimeNs span_ns, std::span<const LidarPoint> points);

/// Returns `empty` (no points), `non_finite` (no finite point), `insufficient_data` (no point in range) or `degenerate`
/// (all points have one time stamp, although the sweep has a duration).
Status check_point_selection(TimeNs span_ns, std::span<const LidarPoint> points, const PointCounts& counts);

}  // namespace tumble::mapping
