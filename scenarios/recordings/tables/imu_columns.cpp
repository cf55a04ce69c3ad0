// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/imu_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/tables/logger_columns.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/recordings/whole_seconds.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kLatest_ns = kSecondsMax * kSecond_ns;

/// Minimum number of columns of a sensor_msgs/Imu table without header.
constexpr std::size_t kColumnsByPlace = 15;

const std::array<std::string, 3> kAxes = {"x", "y", "z"};

/// Columns that `export` writes: each column once, and no other columns.
const std::vector<std::string> kExported = {"stamp_s",  "stamp_ns", "frame_id", "qx",
                                            "qy",       "qz",       "qw",       "orientation_covariance",
                                            "wx_rad_s", "wy_rad_s", "wz_rad_s", "angular_velocity_covariance",
                                            "fx_m_s2",  "fy_m_s2",  "fz_m_s2",  "linear_acceleration_covariance"};

/// Returns the only column that `fits` accepts; a second such column would belong to another sensor.
template <class Fits>
std::optional<std::size_t> find_column(const CsvLine& header, const std::string& name, const Fits& fits) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (!fits(header.fields[i])) continue;
    if (found) fail(header, "two columns have the name " + name);
    found = i;
  }
  return found;
}

std::optional<std::size_t> find_ending(const CsvLine& header, const std::string& name) {
  return find_column(header, name, [&](std::string_view field) { return field.ends_with(name); });
}

std::optional<std::size_t> find_any(const CsvLine& header, const std::vector<std::string>& names) {
  return find_column(header, names.front(), [&](std::string_view field) {
    return std::find(names.begin(), names.end(), field) != names.end();
  });
}

/// Collects the columns of a header that must all exist.
class RequiredColumns {
 public:
  explicit RequiredColumns(const CsvLine& header) : header_(header) {}
  void take(const std::optional<std::size_t>& place, const std::string& name, std::size_t& column) {
    if (place)
      column = *place, ++found_;
    else
      missing_ += " " + name;
  }
  /// Returns false if no column exists; throws BadInput if only some columns exist.
  bool complete() const {
    if (found_ == 0) return false;
    if (!missing_.empty()) fail(header_, "missing columns:" + missing_);
    return true;
  }

 private:
  const CsvLine& header_;
  int found_ = 0;
  std::string missing_;
};

/// Finds columns such as ".../header/stamp", as tools that flatten messages write them.
std::optional<ImuColumns> flattened(const CsvLine& header) {
  ImuColumns layout;
  RequiredColumns columns(header);
  columns.take(find_ending(header, "header/stamp"), "header/stamp", layout.stamp);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string rate = "angular_velocity/" + kAxes[axis], force = "linear_acceleration/" + kAxes[axis];
    columns.take(find_ending(header, rate), rate, layout.rate[axis]);
    columns.take(find_ending(header, force), force, layout.force[axis]);
  }
  layout.stamp_form = StampForm::seconds;
  return columns.complete() ? std::optional(layout) : std::nullopt;
}

/// Finds the columns "wx_rad_s" or "wx", "fx_m_s2", "fx" or "ax", and "stamp_s", "sec", "secs" or "s" with "stamp_ns"
/// and similar names.
std::optional<ImuColumns> named(const CsvLine& header) {
  ImuColumns layout;
  RequiredColumns columns(header);
  columns.take(find_any(header, {"stamp_s", "sec", "secs", "s"}), "stamp_s", layout.stamp);
  columns.take(find_any(header, {"stamp_ns", "nsec", "nsecs", "ns"}), "stamp_ns", layout.stamp_ns);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string rate = "w" + kAxes[i], force = "f" + kAxes[i];
    columns.take(find_any(header, {rate + "_rad_s", rate}), rate + "_rad_s", layout.rate[i]);
    columns.take(find_any(header, {force + "_m_s2", force, "a" + kAxes[i]}), force + "_m_s2", layout.force[i]);
  }
  return columns.complete() ? std::optional(layout) : std::nullopt;
}

/// Throws BadInput unless a header with names of `export` has each of these names once and no other name.
void require_exported(const CsvLine& header) {
  for (const std::string_view field : header.fields) {
    const std::string name(field);
    if (std::find(kExported.begin(), kExported.end(), name) == kExported.end())
      fail(header, "unknown column '" + name + "'" + suggestion(name, kExported));
  }
  for (const std::string& name : kExported) {
    const auto count = std::count(header.fields.begin(), header.fields.end(), name);
    if (count > 1) fail(header, "two columns have the name " + name);
  }
}

double number(const CsvLine& line, std::size_t column) {
  return csv_number(line, column, std::to_string(column));
}

std::int64_t whole_number(const CsvLine& line, std::size_t column, std::int64_t largest) {
  const double value = number(line, column);
  if (value != std::floor(value) || value < 0.0 || value > static_cast<double>(largest)) {
    fail(line, fmt::format("column {} must be a whole number from 0 to {}; it is '{}'", column, largest,
                           std::string(line.fields[column])));
  }
  return static_cast<std::int64_t>(value);
}

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Integer part and decimals of a number.
struct Decimal {
  std::string_view whole, part;

  explicit Decimal(std::string_view text)
      : whole(text.substr(0, text.find('.'))), part(text.substr(std::min(whole.size() + 1, text.size()))) {}
  bool sound() const { return !whole.empty() && all_digits(whole) && all_digits(part); }
};

/// Converts a number in a unit with this many decimals to nanoseconds, without the rounding of a double; empty if the
/// number is invalid.
std::optional<std::int64_t> scaled_ns(const Decimal& number, std::size_t decimals) {
  std::string digits = std::string(number.whole) + std::string(number.part.substr(0, decimals));
  digits.resize(number.whole.size() + decimals, '0');
  std::int64_t whole_ns = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), whole_ns);
  if (!number.sound() || error != std::errc() || whole_ns > kLatest_ns) return std::nullopt;
  return whole_ns + (number.part.size() > decimals && number.part[decimals] >= '5' ? 1 : 0);
}

std::int64_t seconds_ns(const CsvLine& line, std::size_t column) {
  const std::string_view text = line.fields[column];
  const Decimal number(text);
  const auto ns = number.whole.size() <= 10 && number.part.size() <= 9 ? scaled_ns(number, 9) : std::nullopt;
  if (ns) return *ns;
  fail(line, fmt::format("column {} must be seconds with at most nine decimals; it is '{}'", column, text));
}

std::int64_t decimal_ns(const CsvLine& line, std::size_t column, int decimals) {
  const std::string_view text = line.fields[column];
  if (const auto ns = scaled_ns(Decimal(text), static_cast<std::size_t>(decimals))) return *ns;
  fail(line,
       fmt::format("column {} must be a time, digits with or without a decimal point, up to the year 2255; it is '{}'",
                   column, text));
}

/// Returns true if seconds and nanoseconds are in separate columns.
bool has_split_stamp(const CsvLine& header) {
  return find_any(header, {"sec", "secs", "s"}) || find_any(header, {"nsec", "nsecs", "ns"});
}

/// Returns true for a column name that only `export` writes.
bool is_own(std::string_view field) {
  return (field == "stamp_s" || field.ends_with("_rad_s") || field.ends_with("_m_s2")) &&
         std::find(kExported.begin(), kExported.end(), field) != kExported.end();
}

}  // namespace

ImuColumns imu_columns(const CsvLine& first) {
  if (is_number(first.fields.front())) {
    ImuColumns columns;
    columns.has_header = false;
    if (first.fields.size() < kColumnsByPlace) {
      fail(first, fmt::format("has {} columns and no header; it needs {}", first.fields.size(), kColumnsByPlace));
    }
    return columns;
  }
  if (std::optional<ImuColumns> columns = flattened(first)) return *columns;
  const bool own = std::any_of(first.fields.begin(), first.fields.end(), is_own);
  if (own) require_exported(first);
  if (std::optional<ImuColumns> columns = own || has_split_stamp(first) ? named(first) : logger_columns(first)) {
    if (own) columns->gyro_unit = GyroUnit::rad_s, columns->accel_unit = AccelUnit::m_s2;
    return *columns;
  }
  fail(first,
       "contains no known column name: stamp_s, stamp_ns, wx_rad_s, ..., fx_m_s2, ... (as written by 'export'), "
       ".../header/stamp, .../angular_velocity/x, ..., or logger names (time, gyro_x, ..., accel_x, ...). A file "
       "without a header is possible too");
}

std::int64_t stamp_ns(const CsvLine& line, const ImuColumns& columns) {
  switch (columns.stamp_form) {
    case StampForm::seconds:
      return seconds_ns(line, columns.stamp);
    case StampForm::decimal:
      return decimal_ns(line, columns.stamp, columns.stamp_decimals.value_or(9));
    case StampForm::split:
      break;
  }
  return whole_number(line, columns.stamp, kLatest_ns / kSecond_ns) * kSecond_ns +
         whole_number(line, columns.stamp_ns, kSecond_ns - 1);
}

void require_width(const CsvLine& line, std::size_t columns) {
  if (line.fields.size() == columns) return;
  fail(line, fmt::format("has {} columns, but the first line has {}; must be equal", line.fields.size(), columns));
}

int decimals_by_step(CsvText text, std::size_t stamp, std::size_t columns, const std::string& file) {
  constexpr std::size_t kLooked = 1000;
  constexpr double kLeast_s = 0.9e-3, kMost_s = 0.1;
  std::vector<double> steps;
  CsvLine line;
  for (double last = 0.0; steps.size() <= kLooked && text.next(line);) {
    require_width(line, columns);
    const double now = number(line, stamp);
    steps.push_back(now - last);
    last = now;
  }
  if (steps.size() < 2) return 9;  // too few samples; reported later
  steps.erase(steps.begin());      // the first stamp is no step
  const double step = upper_median(steps);
  for (const int decimals : {9, 6, 3, 0}) {
    const double step_s = step * std::pow(10.0, decimals - 9);
    if (step_s >= kLeast_s && step_s < kMost_s) return decimals;
  }
  throw BadInput(
      fmt::format("{}: the time step is {}; in none of s, ms, us and ns is this a rate of 10 to 1000 Hz. Add the unit "
                  "to the column name, as in time_s or 'time [ns]'",
                  file, std::to_string(step)));
}

}  // namespace tumble::scenarios
