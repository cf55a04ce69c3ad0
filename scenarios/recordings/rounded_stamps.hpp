// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// Returns true if all stamps are whole milliseconds after the first, with steps of n or n + 1 ms, n up to 4. Each of
/// the two steps must occur at least once in fifty steps; longer steps are gaps. Periods within 0.02 ms of a whole
/// millisecond are not detected. The cost is O(N).
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Returns increasing time stamps at the true period of the IMU. Each stamp moves by at most a millisecond, to a line
/// that is fitted to the half second on either side, up to the next gap. The cost is O(N).
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
