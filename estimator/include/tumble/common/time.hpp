// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tumble/common/detail/compiled_alike.hpp"  // IWYU pragma: keep

namespace tumble {

/// TimeNs is a time stamp in integer nanoseconds from the start of the recording. Sample k of a regular stream has the
/// stamp t0 + k * period.
using TimeNs = std::int64_t;

/// Converts a duration from nanoseconds to seconds. For durations below 104 days, the relative error of the result is
/// at most 2^-53.
constexpr double seconds(TimeNs span_ns) {
  return static_cast<double>(span_ns) * 1e-9;
}

}  // namespace tumble
