// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tumble/common/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// integer nanoseconds since the start of the recording
using TimeNs = std::int64_t;

/// Largest magnitude of a time stamp that the odometry classes accept: 97 years. Twice the difference of two accepted
/// time stamps fits into 64 bits.
inline constexpr TimeNs kStampMax_ns = 3'070'000'000'000'000'000;

/// The relative error of seconds() is at most 2^-53 for durations below 104 days.
constexpr double seconds(TimeNs span_ns) {
  return static_cast<double>(span_ns) * 1e-9;
}

}  // namespace tumble
