// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/common/types.hpp"

namespace tumble {

/// Largest accepted component of a rate [rad/s] or a force [m/s^2].
inline constexpr double kReadingMax = 1e6;

/// Returns `out_of_range` for a magnitude beyond kStampMax_ns.
Status check_stamp(TimeNs stamp_ns, const char* field);

/// Returns the first error in a sequence of samples: `empty`, an error of check_sample(), or an error of
/// check_stamp_order(). Cost: O(N).
Status check_samples(std::span<const ImuSample> samples, double gap_max_s);

}  // namespace tumble
