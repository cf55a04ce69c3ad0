// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// Stamps of an IMU in whole milliseconds that beats faster than they can say.
namespace tumble::scenarios {

/// Whether stamps are rounded: all of them whole milliseconds from the first one, their steps one number of
/// milliseconds, four at most, or the next, both of which come at least once in fifty steps; longer ones are gaps. An
/// IMU of 500 Hz beats in whole milliseconds and is not rounded. Not told: one whose beat is within 0.02 ms of a whole
/// number of them, whose stamps are off by as much as those of the others. O(N).
bool are_rounded(std::span<const std::int64_t> stamps_ns);

/// Rounded stamps on the beat that they are of: each on the straight line through those within half a second on either
/// side, as far as no gap parts them, and within a millisecond of where it stood. They rise. O(N).
std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns);

/// Mean step of stamps without their gaps. O(N).
std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns);

}  // namespace tumble::scenarios
