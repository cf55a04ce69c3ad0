// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/number_text.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

std::string_view bare_number(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t') || text.ends_with('\r')) text.remove_suffix(1);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool split_decimal(std::string_view text, std::string& digits, int& power) {
  constexpr int kPowerMax = 400;
  power = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string_view::npos) {
    std::string_view exponent = text.substr(e + 1);
    if (exponent.size() > 1 && exponent.front() == '+' && exponent[1] != '-') exponent.remove_prefix(1);
    if (!read_number(exponent, power) || std::abs(power) > kPowerMax) return false;
    text = text.substr(0, e);
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view part = text.substr(std::min(point + 1, text.size()));
  digits = std::string(text.substr(0, point)) + std::string(part);
  power -= static_cast<int>(part.size());
  return all_digits(digits);
}

std::optional<std::int64_t> date_ns(std::string_view text) {
  constexpr std::size_t kSecond = 17;
  constexpr int kHours = 24, kMinutes = 60;
  if (text.ends_with('Z')) text.remove_suffix(1);
  if (text.size() < kSecond + 2 || text[4] != '-' || text[7] != '-' || (text[10] != ' ' && text[10] != 'T') ||
      text[13] != ':' || text[16] != ':')
    return std::nullopt;
  int year = 0, hour = 0, minute = 0;
  unsigned month = 0, day = 0;
  const bool read = read_number(text.substr(0, 4), year) && read_number(text.substr(5, 2), month) &&
                    read_number(text.substr(8, 2), day) && read_number(text.substr(11, 2), hour) &&
                    read_number(text.substr(14, 2), minute);
  const std::optional<std::int64_t> rest_ns = parse_time_ns(text.substr(kSecond), 9);
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  constexpr int kFirst = 1970, kLast = 2254;
  if (!read || !rest_ns || !date.ok() || year < kFirst || year > kLast || hour < 0 || hour >= kHours || minute < 0 ||
      minute >= kMinutes || *rest_ns < 0)
    return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * kHours + hour) * kMinutes + minute) * kMinutes * kSecond_ns + *rest_ns;
}

}  // namespace

bool parse_number(std::string_view text, double& value) {
  return read_number(bare_number(text), value);
}

std::optional<std::int64_t> parse_time_ns(std::string_view text, int decimals) {
  text = bare_number(text);
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  std::string digits;
  int power = 0;
  if (!split_decimal(text, digits, power)) return std::nullopt;
  power += decimals;
  digits.erase(0, digits.find_first_not_of('0'));
  constexpr int kDigitsMax = 19;
  if (digits.empty()) return 0;
  const int whole_digits = static_cast<int>(digits.size()) + power;
  if (whole_digits > kDigitsMax) return std::nullopt;
  if (whole_digits < 0) return 0;
  const bool round_up = power < 0 && digits[static_cast<std::size_t>(whole_digits)] >= '5';
  digits.resize(static_cast<std::size_t>(whole_digits), '0');
  std::int64_t time_ns = 0;
  if (!digits.empty() && !read_number(std::string_view(digits), time_ns)) return std::nullopt;
  if (time_ns >= kSecondsMax * kSecond_ns) return std::nullopt;
  time_ns += round_up ? 1 : 0;
  return negative ? -time_ns : time_ns;
}

std::optional<std::int64_t> parse_stamp_ns(std::string_view text) {
  text = bare_number(text);
  if (all_digits(text) && (text.size() == 13 || text.size() == 16 || text.size() == 19))
    return parse_time_ns(text, 19 - static_cast<int>(text.size()));
  if (const auto date = date_ns(text)) return date;
  return parse_time_ns(text, 9);
}

}  // namespace tumble::scenarios
