// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/built_situation.hpp"

namespace tumble::tools {

/// The versions of program and engine, for recordings.
scenarios::RecordingInfo recording_versions();

/// What the program writes about a recording that it has simulated.
scenarios::RecordingInfo recording_info(const sim::ResolvedSituation& situation, const std::string& digest);

/// The world that a simulated recording was made in, built from what it states; `place` begins the messages. The
/// sensors are left out: they are not simulated again, so that numbers of theirs which this build does not know do no
/// harm. Throws BadInput, sim::InvalidSituation.
sim::BuiltSituation built_from(const scenarios::RecordingInfo& info, const std::string& place,
                               const scenarios::DataRoot& data);

}  // namespace tumble::tools
