// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::tools {

std::string interval_text(const scenarios::Interval& interval);
nlohmann::json finite(double value);
nlohmann::json interval_json(const scenarios::Interval& interval);

}  // namespace tumble::tools
