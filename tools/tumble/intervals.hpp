// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/statistics/statistics.hpp"

/// intervals.hpp formats intervals as text and as JSON.
namespace tumble::tools {

/// Formats the two ends of an interval; "[-]" if neither is known.
std::string interval_text(const scenarios::Interval& interval);
/// Returns null for non-finite values, which JSON cannot represent.
nlohmann::json finite(double value);
nlohmann::json interval_json(const scenarios::Interval& interval);

}  // namespace tumble::tools
