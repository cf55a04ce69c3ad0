// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/methods/external_description.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Reads the result of an external command from `output`, and the map from `map` if this file exists. The time stamps
/// of poses are bag stamps, which start at kExportOrigin_ns, or times of the recording. Throws BadInput with location
/// and reason for a missing file, a cell without a number, values outside AnswerBounds, decreasing times, or rates that
/// do not match the samples of the first IMU.
Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
