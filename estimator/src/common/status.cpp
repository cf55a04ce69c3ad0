// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/status.hpp"

#include <array>
#include <charconv>

namespace tumble {

namespace {

// Returns the shortest decimal text that converts back to exactly `value`, in any locale.
std::string text_of_number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return std::string(text.data(), end.ptr);
}

}  // namespace

const char* to_string(ErrorCode error_code) {
  switch (error_code) {
    case ErrorCode::none:
      return "ok";
    case ErrorCode::empty:
      return "empty";
    case ErrorCode::non_finite:
      return "non_finite";
    case ErrorCode::time_order:
      return "time_order";
    case ErrorCode::gap:
      return "gap";
    case ErrorCode::out_of_range:
      return "out_of_range";
    case ErrorCode::insufficient_data:
      return "insufficient_data";
    case ErrorCode::degenerate:
      return "degenerate";
    case ErrorCode::diverged:
      return "diverged";
  }
  return "unknown";
}

std::string Status::message() const {
  if (ok()) return "ok";
  return std::string(to_string(error_code)) + ": " + field + " is " + text_of_number(value) + "; the bound is " +
         text_of_number(bound);
}

InvalidParams::InvalidParams(const std::string& field, double value, const std::string& bound)
    : std::invalid_argument(field + " is " + text_of_number(value) + "; it must be " + bound) {}

void require_in_interval(const char* field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw InvalidParams(field, value, "within [" + text_of_number(low) + ", " + text_of_number(high) + "]");
}

}  // namespace tumble
