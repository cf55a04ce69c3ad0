// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace tumble::scenarios {

/// Parses a number in decimal or scientific notation, with an optional sign and surrounding blanks; also accepts nan
/// and inf.
bool parse_number(std::string_view text, double& value);

/// Converts a decimal time to integer nanoseconds without rounding errors. The decimal point is moved by `decimals`
/// places: 9 for s, 6 for ms, 3 for us, 0 for ns.
std::optional<std::int64_t> parse_time_ns(std::string_view text, int decimals);

/// Parses a time stamp since 1970: decimal seconds, an integer of 13, 16 or 19 digits (ms, us, ns), or a date in UTC
/// ("2011-09-26 13:02:25.964389445").
std::optional<std::int64_t> parse_stamp_ns(std::string_view text);

inline std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

inline void append_seconds(std::string& text, std::int64_t time_ns) {
  const std::uint64_t size =
      time_ns < 0 ? 0 - static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  const std::string nanoseconds = std::to_string(size % 1000000000);
  text += time_ns < 0 ? "-" : "";
  text += std::to_string(size / 1000000000) + "." + std::string(9 - nanoseconds.size(), '0') + nanoseconds;
}

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// The largest accepted time stamp, 9 000 000 000 s (year 2255), fits in a 64-bit number of nanoseconds.
inline constexpr std::int64_t kSecondsMax = 9'000'000'000;

}  // namespace tumble::scenarios
