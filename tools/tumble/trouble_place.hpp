// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/recording.hpp"
#include "tumble/common/status.hpp"

namespace tumble::tools {

/// Where in a recording the trouble lies for which a method refused it: between which times the longest gap is, or
/// which reading of which IMU is the first that is no number, beyond its bound or out of order; "" where readings are
/// not to blame. O(N).
std::string trouble_place(const Status& status, const sim::Sensors& sensors);

}  // namespace tumble::tools
