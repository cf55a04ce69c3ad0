// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"

namespace tumble::scenarios {

/// Returns a digest of all files that determine simulated runs: models, scenarios and named cases. All outcomes in one
/// database have the same data digest.
std::string data_digest(const DataRoot& data);

}  // namespace tumble::scenarios
