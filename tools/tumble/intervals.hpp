// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scenarios/statistics/statistics.hpp"

/// The functions in intervals.hpp format intervals for people (text) and for programs (JSON).
namespace tumble::tools {

/// Formats the two ends of an interval; "[-]" if neither is known.
std::string interval_text(const scenarios::Interval& interval);
/// Returns null for values that are not finite, because JSON cannot represent such values.
nlohmann::json finite(double value);
nlohmann::json interval_json(const scenarios::Interval& interval);

}  // namespace tumble::tools
