// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

std::string manifest_of(const Dialect& dialect, const SensorFacts& facts, const RecordingInfo& info,
                        std::int64_t origin_ns, const std::vector<std::string>& configuration, bool with_truth);

}  // namespace tumble::scenarios
