// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tumble::scenarios {

/// Returns true if the time stamps seem to be rounded to milliseconds. In this case, all steps between time stamps are
/// n or n + 1 ms, for an n of at most 4. At least 2 % of the steps must be n ms, and at least 2 % must be n + 1 ms;
/// longer steps are gaps. If the true sample period is within 0.02 ms of a whole millisecond, the function returns
/// false.
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Removes the rounding of time stamps. For each stamp, a line is fitted to the stamps within half a second, without
/// stamps beyond a gap. The stamp is replaced by the value of the line, but moves by at most a millisecond.
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
