// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"

namespace tumble::scenarios {

/// Digest of every file that a draw is made of, models, catalogue and named cases: outcomes of two catalogues do not
/// mix in one database.
std::string data_digest(const DataRoot& data);

}  // namespace tumble::scenarios
