// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/methods/external_description.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Reads the result of a command at `output` as an estimate of the description's kind, and the map at `map` if the file
/// exists. The stamps of poses are either bag stamps, which start at kExportOrigin_ns, or the recording's times. Throws
/// BadInput with location and reason for a missing or empty file, a cell that is not a number, values outside
/// AnswerBounds, or decreasing time. Throws BadInput also if the rates do not match the samples of the first IMU.
Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
