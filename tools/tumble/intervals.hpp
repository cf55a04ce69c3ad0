// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/statistics/statistics.hpp"

/// An interval as people and as programs read it.
namespace tumble::tools {

/// Of the ends alone; "[-]" where neither is known.
std::string interval_text(const scenarios::Interval& interval);
/// Null where it is not finite, which JSON cannot say.
nlohmann::json finite(double value);
nlohmann::json interval_json(const scenarios::Interval& interval);

}  // namespace tumble::tools
