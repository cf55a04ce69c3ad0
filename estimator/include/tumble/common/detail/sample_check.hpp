// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/common/imu.hpp"

namespace tumble {

/// Largest plausible component of a rate [rad/s] or a force [m/s^2], whose square remains finite. check_sample()
/// returns `out_of_range` for larger readings.
inline constexpr double kReadingMax = 1e6;

/// Returns `out_of_range` for a magnitude beyond kStampMax_ns.
Status check_stamp(TimeNs stamp_ns, const char* field);

/// Returns the first error in a sequence of samples: `empty`, the error of a single sample (check_sample()), or the
/// error of a pair (check_stamp_order()). Cost: O(N).
Status check_samples(std::span<const ImuSample> samples, double gap_max_s);

}  // namespace tumble
