// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/methods/external_description.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Stamp of a recording's start in the bags for external commands. The poses that a command returns may use the bag's
/// or the recording's stamps.
inline constexpr std::int64_t kExternalBagOrigin_ns = 1'000'000'000'000'000'000;

/// Reads the result of a command at `output` as an estimate of the description's kind, and the map at `map` if the file
/// exists. Throws BadInput with location and reason for a missing or empty file, a cell that is not a number, values
/// outside AnswerBounds, or decreasing time. Throws BadInput also if the rates do not match the samples of the first
/// IMU.
Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
