// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tumble/common/detail/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// TimeNs is a time stamp in integer nanoseconds from the start of the recording. Sample k of a regular stream has the
/// stamp t0 + k * period.
using TimeNs = std::int64_t;

/// Largest time stamp that the odometry classes accept, in either direction: 97 years. Twice the difference of two
/// stamps then fits into 64 bits.
inline constexpr TimeNs kStampMax_ns = 3'070'000'000'000'000'000;

/// Converts a duration to seconds. The result is exact to 2^-53 relative for durations below 104 days.
constexpr double seconds(TimeNs span_ns) {
  return static_cast<double>(span_ns) * 1e-9;
}

}  // namespace tumble
