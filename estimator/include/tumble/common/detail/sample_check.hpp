// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Largest accepted component of a rate [rad/s] or a force [m/s^2].
inline constexpr double kReadingMax = 1e6;

/// Returns `out_of_range` for a magnitude beyond kStampMax_ns.
Status check_stamp(TimeNs stamp_ns, const char* field);

/// Returns the first error in a sequence of samples: `empty`, an error of check_sample(), or an error of
/// check_stamp_order(). Cost: O(N).
Status check_samples(std::span<const ImuSample> samples, double gap_max_s);

/// Checks the samples of a recording. Returns `empty`, `insufficient_data` (fewer than `count_min` samples), an error
/// of check_samples(), or `ok`. Cost: O(N).
Status check_recording(std::span<const ImuSample> samples, std::size_t count_min, double gap_max_s);

/// Returns the median time between samples, limited to 1 us and 10 s. The recording must have at least two samples.
/// Cost: O(N).
double median_period_s(std::span<const ImuSample> samples);

/// Computes the time `dt_s` between two time stamps, without overflow if `gap_max_s` is at most 1e9. On error, returns
/// the status of check_stamp_order() and leaves `dt_s` unchanged.
Status elapsed_time_since_last(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s);

}  // namespace tumble
