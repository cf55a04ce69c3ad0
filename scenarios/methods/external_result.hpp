// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/methods/external_description.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Reads the result of a command at `output` as an estimate of the description's kind, and the map at `map` if the file
/// exists. Throws BadInput with location and reason for a missing or empty file, values outside AnswerBounds, a cell
/// that is not a number, or decreasing time. Also throws BadInput if the rates do not match the samples of the first
/// IMU. The stamps of poses may be those of the bag, which starts at kExportOrigin_ns, or of the recording.
Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
