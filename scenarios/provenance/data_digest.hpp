// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"

namespace tumble::scenarios {

/// Returns a digest of all files that determine simulated runs: models, catalogue and named cases. Outcomes with
/// different data digests are not stored in one database.
std::string data_digest(const DataRoot& data);

}  // namespace tumble::scenarios
