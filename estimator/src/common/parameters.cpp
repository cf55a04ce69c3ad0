// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/parameters.hpp"

#include <string>

namespace tumble::detail {

void BoundsChecker::check(double value, const ParameterInfo& field) {
  if (!out_.status.ok() || (value >= field.low && value <= field.high)) return;
  out_.names.at(out_.prefix_count++) = field.name;
  const bool above = value > field.high;
  out_.status = {ErrorCode::out_of_range, field.name, value, above ? field.high : field.low};
  out_.low = field.low;
  out_.high = field.high;
}

void throw_if_out_of_bounds(const OutOfBoundsParameter& found) {
  if (found.status.ok()) return;
  std::string name;
  for (std::size_t k = 0; k < found.prefix_count; ++k) name += found.names.at(k);
  require_in_interval(name.c_str(), found.status.value, found.low, found.high);
}

}  // namespace tumble::detail
