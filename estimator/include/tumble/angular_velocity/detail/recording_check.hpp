// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "tumble/common/types.hpp"

namespace tumble {

/// Checks the samples of a recording. Returns `empty`, `insufficient_data` (fewer than `count_min` samples), an error
/// of check_samples(), or `ok`. Cost: O(N).
Status check_recording(std::span<const ImuSample> samples, std::size_t count_min, double gap_max_s);

/// Returns the median time between samples, limited to 1 us and 10 s. The recording must have at least two samples.
/// Cost: O(N).
double median_period_s(std::span<const ImuSample> samples);

}  // namespace tumble
