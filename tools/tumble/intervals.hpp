// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/statistics/statistics.hpp"
#include "tools/tables/table.hpp"

/// An interval as people and as programs read it.
namespace tumble::tools {

/// Of the ends alone; "[-]" where neither is known.
inline std::string interval_text(const scenarios::Interval& interval) {
  if (!std::isfinite(interval.low) && !std::isfinite(interval.high)) return "[-]";
  return "[" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
}

/// Null where it is not finite, which JSON cannot say.
inline nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

inline nlohmann::json interval_json(const scenarios::Interval& interval) {
  return {{"value", finite(interval.value)}, {"low", finite(interval.low)}, {"high", finite(interval.high)}};
}

}  // namespace tumble::tools
