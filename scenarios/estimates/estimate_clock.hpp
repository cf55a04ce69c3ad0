// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scenarios/estimates/estimate.hpp"
#include "scenarios/recordings/recording_clock.hpp"

namespace tumble::scenarios {

/// Shifts the time stamps of an estimate to the clock of the recording. The original time stamps of the estimate may be
/// in the clock of the recording, the clock of the imported file, or the clock of exported files.
void move_to_clock(std::int64_t origin_ns, const StampSpan& span, Estimate& estimate);

}  // namespace tumble::scenarios
