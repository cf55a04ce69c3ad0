// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// rounded_stamps.hpp restores stamps of an IMU that were rounded to milliseconds although its period is not a whole
/// number of milliseconds.
namespace tumble::scenarios {

/// Returns whether time stamps are rounded to milliseconds. Rounded stamps are whole milliseconds after the first
/// stamp, and their steps are n or n + 1 milliseconds, n up to 4. The steps n and n + 1 must each occur at least once
/// in fifty steps. Longer steps count as gaps. The stamps of a 500 Hz IMU are whole milliseconds and not rounded.
/// Periods within 0.02 ms of a whole millisecond are not detected. Cost: O(N).
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Returns time stamps on the IMU's true period. Each stamp moves to a line that is fitted within half a second on
/// either side, not across gaps. A stamp moves by at most a millisecond. The returned time stamps increase. Cost: O(N).
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

/// Returns the mean step between stamps, without gaps. Cost: O(N).
std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
