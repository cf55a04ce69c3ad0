// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tumble::scenarios {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// The largest time stamp, 9 000 000 000 s (year 2255), fits in 64 bits of nanoseconds.
inline constexpr std::int64_t kSecondsMax = 9'000'000'000;

}  // namespace tumble::scenarios
