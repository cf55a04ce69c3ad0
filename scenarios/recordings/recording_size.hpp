// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/recordings/recording_file.hpp"

/// Used only within scenarios/recordings.
namespace tumble::scenarios {

/// Returns an upper bound of a recording's file size [bytes]. The size bound assumes uncompressed numbers, full chunks
/// and large headers.
std::uint64_t size_bound(const RecordingInfo& info, const sim::Sensors& sensors, const std::vector<PointStore>& points,
                         const sim::Truth* truth);

}  // namespace tumble::scenarios
