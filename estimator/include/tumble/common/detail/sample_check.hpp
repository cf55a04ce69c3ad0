// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tumble/common/imu.hpp"

namespace tumble {

/// Largest component of a rate [rad/s] or a force [m/s^2]: no sensor says more, and squares of it stay finite. Beyond,
/// check_sample() finds a reading `out_of_range`.
inline constexpr double kReadingMax = 1e6;

/// The first trouble of a sequence of samples, none included: of one by itself (check_sample()), or of how it follows
/// the one before (check_follows()). O(N).
Status check_samples(std::span<const ImuSample> samples, double gap_max_s);

}  // namespace tumble
