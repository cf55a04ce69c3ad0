// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/methods/external_description.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Stamp of a recording's start in the bags that a command is given; its poses may bear those stamps or the
/// recording's.
inline constexpr std::int64_t kExternalBagOrigin_ns = 1'000'000'000'000'000'000;

/// What a command left at `output` as an estimate of the description's kind, and the map where there is one at `map`.
/// Throws BadInput with place and reason: absent, beyond AnswerBounds in size or in what it says, empty, a cell that is
/// no number, time that goes back, rates that do not answer each sample of the first IMU.
Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
