// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/methods/method.hpp"
#include "scenarios/recordings/recording_clock.hpp"

namespace tumble::scenarios {

/// Converts the time stamps of an estimate from another program to the clock of the recording. The time stamps may use
/// the clock of the recording, of the original file (`origin_ns`), or of exported files (export_origin_ns). The
/// parameter `span` is the time range of the recording. Time stamps that fit none of the three clocks stay unchanged.
void move_to_clock(std::int64_t origin_ns, const StampSpan& span, Estimate& estimate);

}  // namespace tumble::scenarios
