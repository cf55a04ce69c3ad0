// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// Returns true if all stamps are whole milliseconds after the first stamp, with steps of n or n + 1 ms, n up to 4.
/// Steps of n ms and steps of n + 1 ms must each be at least 2 % of the steps; longer steps are gaps. If the true
/// sample period is within 0.02 ms of a whole millisecond, the function returns false.
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Removes the rounding of time stamps. Each stamp moves, by at most a millisecond, to a line that is fitted to the
/// stamps at most half a second away. Stamps beyond a gap are not used for the fit.
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
