// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/status.hpp"

#include <sstream>

namespace tumble {

const char* to_string(Trouble trouble) {
  switch (trouble) {
    case Trouble::none: return "ok";
    case Trouble::empty: return "empty";
    case Trouble::non_finite: return "non_finite";
    case Trouble::time_order: return "time_order";
    case Trouble::gap: return "gap";
    case Trouble::out_of_range: return "out_of_range";
    case Trouble::too_few: return "too_few";
    case Trouble::degenerate: return "degenerate";
    case Trouble::diverged: return "diverged";
  }
  return "unknown";
}

std::string Status::message() const {
  if (ok()) return "ok";
  std::ostringstream text;
  text.precision(17);
  text << to_string(trouble) << ": " << field << " is " << value << ", bound " << bound;
  return text.str();
}

namespace {
std::string describe(const std::string& field, double value, const std::string& bound) {
  std::ostringstream text;
  text << field << " is " << value << ", must be " << bound;
  return text.str();
}
}  // namespace

InvalidParams::InvalidParams(const std::string& field, double value, const std::string& bound)
    : std::invalid_argument(describe(field, value, bound)) {}

void require_within(const char* field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream bound;
  bound << "within [" << low << ", " << high << "]";
  throw InvalidParams(field, value, bound.str());
}

}  // namespace tumble
