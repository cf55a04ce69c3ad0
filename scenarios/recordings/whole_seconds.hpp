// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

/// Splits time stamps into whole seconds and nanoseconds.
namespace tumble::scenarios {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// Largest seconds of a stamp. The stamp in nanoseconds must fit in 64 bits (the year 2255).
inline constexpr std::int64_t kSecondsMax = 9'000'000'000;

}  // namespace tumble::scenarios
