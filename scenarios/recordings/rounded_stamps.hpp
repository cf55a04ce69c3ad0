// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// Restores stamps of an IMU that were rounded to milliseconds although its period is not a whole number of them.
namespace tumble::scenarios {

/// Returns true if stamps are rounded to milliseconds: all are whole milliseconds from the first, and their steps are n
/// or n + 1 milliseconds, n up to 4. Both steps must occur at least once in fifty steps. Longer steps are gaps. A 500
/// Hz IMU has whole milliseconds and is not rounded. Periods within 0.02 ms of a whole millisecond are not detected.
/// O(N).
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Returns rounded stamps on the IMU's true period: each on a line fitted within half a second on either side, not
/// across gaps, and within a millisecond of its old value. The result increases. O(N).
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

/// Returns the mean step without gaps. O(N).
std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
