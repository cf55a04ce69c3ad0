// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"
#include "tumble/common/status.hpp"

namespace tumble::tools {

/// Describes why a method rejected a recording: the longest gap, or the first IMU reading that is not finite, out of
/// range or out of order. If no sweep was registered, the text is the number of points in a sweep. Returns an empty
/// text if none of these is the cause. The cost is O(N).
std::string trouble_place(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
