// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"

namespace tumble::tools {

scenarios::RecordingInfo recording_versions();

scenarios::RecordingInfo recording_info(const sim::ResolvedSituation& situation, const std::string& digest);

/// Returns a note if the body still moves at the end of the recording (faster than 0.05 m/s or 0.25 rad/s), because the
/// scenario's `duration_s` may be too short.
std::string end_in_motion(const sim::Truth& truth);

sim::BuiltSituation built_from(const scenarios::RecordingInfo& info, const std::string& place,
                               const scenarios::DataRoot& data);

}  // namespace tumble::tools
