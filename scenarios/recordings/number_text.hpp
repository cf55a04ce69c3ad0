// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string>

namespace tumble::scenarios {

/// Appends the shortest text that parses to an equal number.
template <class Number>
void append_number(std::string& text, Number value) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

/// Returns the value with three significant digits, for messages.
inline std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

/// Appends seconds with nine decimals, exactly, from whole nanoseconds.
inline void append_seconds(std::string& text, std::int64_t time_ns) {
  const std::uint64_t size =
      time_ns < 0 ? 0 - static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  const std::string nanoseconds = std::to_string(size % 1000000000);
  text += time_ns < 0 ? "-" : "";
  text += std::to_string(size / 1000000000) + "." + std::string(9 - nanoseconds.size(), '0') + nanoseconds;
}

}  // namespace tumble::scenarios
