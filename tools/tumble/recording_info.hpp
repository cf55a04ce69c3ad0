// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"

namespace tumble::tools {

/// The versions of program and engine, for recordings.
scenarios::RecordingInfo recording_versions();

/// What the program writes about a recording that it has simulated.
scenarios::RecordingInfo recording_info(const sim::ResolvedSituation& situation, const std::string& digest);

/// What there is to say of a motion that goes on where the recording ends, as of a scenario whose `duration_s` is too
/// short; empty of one that ends at rest (0.05 m/s, 0.25 rad/s).
std::string end_in_motion(const sim::Truth& truth);

/// The world that a simulated recording was made in, built from what it states; `place` begins the messages. The
/// sensors are left out: they are not simulated again, so that numbers of theirs which this build does not know do no
/// harm. Throws BadInput, sim::InvalidSituation.
sim::BuiltSituation built_from(const scenarios::RecordingInfo& info, const std::string& place,
                               const scenarios::DataRoot& data);

}  // namespace tumble::tools
