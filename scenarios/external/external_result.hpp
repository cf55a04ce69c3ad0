// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "scenarios/estimates/method.hpp"
#include "scenarios/external/external_description.hpp"

namespace tumble::scenarios {

/// The time stamps of the poses of an external program may start at kExportOrigin_ns (clock of exported bags) or at
/// zero (clock of the recording).
Estimate read_external_result(const ExternalDescription& description, const std::filesystem::path& output,
                              const std::filesystem::path& map, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
