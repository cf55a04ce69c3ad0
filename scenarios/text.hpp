// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>

namespace tumble::scenarios {

template <typename Number>
bool read_number(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Appends a number as the shortest text that gives exactly this number when the text is parsed.
template <typename Number>
void append_number(std::string& text, Number value) {
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

template <typename Number>
std::string exact_text(Number value) {
  std::string text;
  append_number(text, value);
  return text;
}

inline std::string shortened(std::string_view text, std::size_t most = 120) {
  return text.size() <= most ? std::string(text) : std::string(text.substr(0, most)) + "...";
}

inline std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return text;
}

}  // namespace tumble::scenarios
