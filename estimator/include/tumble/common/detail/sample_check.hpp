// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/common/imu.hpp"

namespace tumble {

/// Largest plausible component of a rate [rad/s] or a force [m/s^2]. Squares of components up to kReadingMax remain
/// finite. The function check_sample() returns `out_of_range` for larger readings.
inline constexpr double kReadingMax = 1e6;

/// Returns the first error in a sequence of samples: `empty`, an error of check_sample(), or an error of
/// check_follows(). Cost: O(N).
Status check_samples(std::span<const ImuSample> samples, double gap_max_s);

}  // namespace tumble
