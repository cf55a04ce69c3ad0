// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

std::uint64_t size_bound(const RecordingInfo& info, const sim::Sensors& sensors, const std::vector<PointStore>& points,
                         const sim::Truth* truth);

}  // namespace tumble::scenarios
