// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/data_root.hpp"

namespace tumble::scenarios {

std::string data_digest(const DataRoot& data);

}  // namespace tumble::scenarios
