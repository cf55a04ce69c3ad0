// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

/// Returns the text of manifest.json (keys: dialects/README.md). manifest.json lists the files with units, stamps and
/// frames, the noise, ranges and mounting of the sensors, and the estimator's documentation. Used only within
/// scenarios/recordings/dialects.
std::string manifest_of(const Dialect& dialect, const SensorFacts& facts, const RecordingInfo& info,
                        std::int64_t origin_ns, const std::vector<std::string>& configuration, bool with_truth);

}  // namespace tumble::scenarios
