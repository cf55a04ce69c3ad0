// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/intervals.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/tables/table.hpp"

namespace tumble::tools {

std::string interval_text(const scenarios::Interval& interval) {
  if (!std::isfinite(interval.low) && !std::isfinite(interval.high)) return "[-]";
  return "[" + number_text(interval.low) + ", " + number_text(interval.high) + "]";
}

nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json interval_json(const scenarios::Interval& interval) {
  return {{"value", finite(interval.value)}, {"low", finite(interval.low)}, {"high", finite(interval.high)}};
}

}  // namespace tumble::tools
