// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/binned_metric.hpp"

#include <sstream>

#include "scenarios/text.hpp"

namespace tumble::scenarios {

std::string BinnedMetric::name() const {
  std::ostringstream text;
  text << base << '@' << axis << ':' << low << ':' << high;
  return text.str();
}

std::optional<BinnedMetric> parse_binned(const std::string& metric) {
  const std::size_t at = metric.find('@'), first = metric.find(':', at), second = metric.find(':', first + 1);
  if (at == std::string::npos || first == std::string::npos || second == std::string::npos) return std::nullopt;
  BinnedMetric binned{metric.substr(0, at), metric.substr(at + 1, first - at - 1), 0.0, 0.0};
  if (!read_number(metric.substr(first + 1, second - first - 1), binned.low)) return std::nullopt;
  if (!read_number(metric.substr(second + 1), binned.high)) return std::nullopt;
  return binned;
}

}  // namespace tumble::scenarios
