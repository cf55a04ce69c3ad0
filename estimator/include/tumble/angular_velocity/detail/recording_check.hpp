// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "tumble/common/imu.hpp"

namespace tumble {

/// What every estimator over a whole recording asks of it: `empty`, `too_few` below `count_min` samples, and what
/// check_samples() finds; ok otherwise. O(N).
Status check_recording(std::span<const ImuSample> samples, std::size_t count_min, double gap_max_s);

/// Median time between samples, at least 1 us and at most 10 s; needs two samples. O(N).
double median_period_s(std::span<const ImuSample> samples);

}  // namespace tumble
