// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/recordings/recording_file.hpp"
#include "sim/situation.hpp"

namespace tumble::tools {

/// What the program writes about a recording that it has simulated.
scenarios::RecordingInfo recording_info(const sim::Situation& situation, const std::string& digest);

}  // namespace tumble::tools
