// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

/// whole_seconds.hpp splits time stamps into whole seconds and nanoseconds.
namespace tumble::scenarios {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// Largest number of seconds in a time stamp: in nanoseconds, it must fit in 64 bits (year 2255).
inline constexpr std::int64_t kSecondsMax = 9'000'000'000;

}  // namespace tumble::scenarios
