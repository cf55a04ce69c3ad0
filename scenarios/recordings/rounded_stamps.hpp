// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// rounded_stamps.hpp restores IMU time stamps that were rounded to milliseconds, although the period is not a whole
/// number of milliseconds.
namespace tumble::scenarios {

/// Returns true if the time stamps are rounded to milliseconds. Rounded time stamps are whole milliseconds after the
/// first, and their steps are n or n + 1 milliseconds, with n up to 4. Each of the two steps must occur at least once
/// in fifty steps; longer steps are gaps. Periods within 0.02 ms of a whole millisecond, such as that of a 500 Hz IMU,
/// are not detected. The cost is O(N).
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Returns the time stamps without rounding, at the true period of the IMU. Each time stamp is moved to a line that is
/// fitted to the half second on either side, up to the next gap. A time stamp moves by at most a millisecond. The
/// returned time stamps increase. The cost is O(N).
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

/// Returns the mean step between time stamps; gaps are not counted. The cost is O(N).
std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
