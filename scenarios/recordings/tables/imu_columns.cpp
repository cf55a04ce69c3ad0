// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/imu_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/tables/logger_columns.hpp"
#include "scenarios/recordings/upper_median.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kColumnsByPlace = 15;

const std::array<std::string, 3> kAxisNames = {"x", "y", "z"};

const std::vector<std::string> kExported = {"stamp_s",  "stamp_ns", "frame_id", "qx",
                                            "qy",       "qz",       "qw",       "orientation_covariance",
                                            "wx_rad_s", "wy_rad_s", "wz_rad_s", "angular_velocity_covariance",
                                            "fx_m_s2",  "fy_m_s2",  "fz_m_s2",  "linear_acceleration_covariance"};

template <class Fits>
std::optional<std::size_t> find_column(const CsvLine& header, const std::string& name, const Fits& fits) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (!fits(header.fields[i])) continue;
    if (found) fail(header, fmt::format("two columns have the name {}; column names must be unique", name));
    found = i;
  }
  return found;
}

std::optional<std::size_t> find_ending(const CsvLine& header, const std::string& name) {
  return find_column(header, name, [&](std::string_view field) {
    std::string parts(field);
    std::replace(parts.begin(), parts.end(), '.', '/');
    return parts.ends_with(name);
  });
}

std::optional<std::size_t> find_any_ending(const CsvLine& header, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (const auto found = find_ending(header, name)) return found;
  }
  return std::nullopt;
}

std::optional<std::size_t> find_any(const CsvLine& header, const std::vector<std::string>& names) {
  return find_column(header, names.front(), [&](std::string_view field) {
    return std::find(names.begin(), names.end(), field) != names.end();
  });
}

class RequiredColumns {
 public:
  explicit RequiredColumns(const CsvLine& header) : header_(header) {}
  void take(const std::optional<std::size_t>& place, const std::string& name, std::size_t& column) {
    if (place)
      column = *place, ++found_;
    else
      missing_ += " " + name;
  }
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

/// The column "field.header.stamp" of `rostopic echo -p` contains nanoseconds, whereas other tools write seconds, or
/// seconds and nanoseconds in two columns.
bool find_header_stamp(const CsvLine& header, ImuColumns& layout) {
  const auto seconds = find_any_ending(header, {"header/stamp/sec", "header/stamp/secs"});
  const auto rest = find_any_ending(header, {"header/stamp/nsec", "header/stamp/nsecs", "header/stamp/nanosec"});
  if (seconds && rest) {
    layout.stamp = *seconds, layout.stamp_ns = *rest;
    return true;
  }
  const auto stamp = find_ending(header, "header/stamp");
  if (!stamp) return false;
  layout.stamp_form = StampForm::decimal;
  layout.stamp = *stamp;
  layout.stamp_decimals = header.fields[*stamp].starts_with("field.") ? 0 : 9;
  return true;
}

/// Finds the columns of a table of ROS messages. The stamp in the message header has priority over the time at which
/// the message was recorded.
std::optional<ImuColumns> flattened(const CsvLine& header) {
  ImuColumns layout;
  if (!find_header_stamp(header, layout)) return std::nullopt;
  RequiredColumns columns(header);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string rate = "angular_velocity/" + kAxisNames[axis], force = "linear_acceleration/" + kAxisNames[axis];
    columns.take(find_ending(header, rate), rate, layout.rate[axis]);
    columns.take(find_ending(header, force), force, layout.force[axis]);
  }
  return columns.complete() ? std::optional(layout) : std::nullopt;
}

std::optional<ImuColumns> named(const CsvLine& header) {
  ImuColumns layout;
  RequiredColumns columns(header);
  columns.take(find_any(header, {"stamp_s", "sec", "secs", "s"}), "stamp_s", layout.stamp);
  columns.take(find_any(header, {"stamp_ns", "nsec", "nsecs", "ns"}), "stamp_ns", layout.stamp_ns);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string rate = "w" + kAxisNames[i], force = "f" + kAxisNames[i];
    columns.take(find_any(header, {rate + "_rad_s", rate}), rate + "_rad_s", layout.rate[i]);
    columns.take(find_any(header, {force + "_m_s2", force, "a" + kAxisNames[i]}), force + "_m_s2", layout.force[i]);
  }
  return columns.complete() ? std::optional(layout) : std::nullopt;
}

void require_exported(const CsvLine& header) {
  for (const std::string_view field : header.fields) {
    const std::string name(field);
    if (std::find(kExported.begin(), kExported.end(), name) == kExported.end())
      fail(header, "unknown column '" + name + "'" + suggestion(name, kExported));
  }
  for (const std::string& name : kExported) {
    const auto count = std::count(header.fields.begin(), header.fields.end(), name);
    if (count > 1) fail(header, fmt::format("two columns have the name {}; column names must be unique", name));
  }
}

double number(const CsvLine& line, std::size_t column) {
  return csv_number(line, column, std::to_string(column));
}

std::int64_t whole_number(const CsvLine& line, std::size_t column, std::int64_t largest) {
  const double value = number(line, column);
  if (value != std::floor(value) || value < 0.0 || value > static_cast<double>(largest)) {
    fail(line, fmt::format("column {} must contain a whole number from 0 to {}, but contains '{}'", column, largest,
                           std::string(line.fields[column])));
  }
  return static_cast<std::int64_t>(value);
}

std::int64_t decimal_ns(const CsvLine& line, std::size_t column, int decimals) {
  const std::string_view text = line.fields[column];
  if (const auto ns = is_number(text) ? parse_time_ns(text, decimals) : parse_stamp_ns(text)) return *ns;
  fail(line, fmt::format("column {} must contain a time up to the year 2255, but contains '{}'", column, text));
}

bool has_split_stamp(const CsvLine& header) {
  return find_any(header, {"sec", "secs", "s"}) || find_any(header, {"nsec", "nsecs", "ns"});
}

bool is_own(std::string_view field) {
  return (field == "stamp_s" || field.ends_with("_rad_s") || field.ends_with("_m_s2")) &&
         std::find(kExported.begin(), kExported.end(), field) != kExported.end();
}

}  // namespace

ImuColumns imu_columns(const LoggedTable& table) {
  const CsvLine& first = table.header();
  if (!table.has_header()) {
    if (first.fields.size() < kColumnsByPlace) {
      fail(first, fmt::format("the file has {} columns and no header; a file without header must have {}. Name the "
                              "columns by their positions, counted from 0: --columns time=0,gyro=1,2,3,accel=4,5,6",
                              first.fields.size(), kColumnsByPlace));
    }
    return {};
  }
  if (std::optional<ImuColumns> columns = flattened(first)) return *columns;
  const bool own = std::any_of(first.fields.begin(), first.fields.end(), is_own);
  if (own) require_exported(first);
  if (std::optional<ImuColumns> columns = own || has_split_stamp(first) ? named(first) : logger_columns(first)) {
    if (own) columns->gyro_unit = GyroUnit::rad_s, columns->accel_unit = AccelUnit::m_s2;
    return *columns;
  }
  fail(first,
       "the header contains no known column name. Known names: stamp_s, stamp_ns, wx_rad_s, ..., fx_m_s2, ... (as "
       "written by 'export'), .../header/stamp, .../angular_velocity/x, ..., and logger names (time, gyro_x, ..., "
       "accel_x, ...). Name the columns: --columns time=NAME,gyro=X,Y,Z,accel=X,Y,Z");
}

std::int64_t stamp_ns(const CsvLine& line, const ImuColumns& columns) {
  if (columns.stamp_form == StampForm::decimal)
    return decimal_ns(line, columns.stamp, columns.stamp_decimals.value_or(9));
  return whole_number(line, columns.stamp, kSecondsMax) * kSecond_ns +
         whole_number(line, columns.stamp_ns, kSecond_ns - 1);
}

int decimals_by_step(LoggedTable& table, std::size_t stamp, const std::string& file) {
  constexpr std::size_t kLooked = 1000;
  constexpr double kLeast_s = 0.9e-3, kMost_s = 0.1;
  std::vector<double> steps;
  CsvLine line;
  table.restart();
  for (double now = 0.0, last = 0.0; steps.size() <= kLooked && table.next_sound(line); last = now) {
    if (parse_number(line.fields[stamp], now)) steps.push_back(now - last);
  }
  table.restart();
  if (steps.size() < 2) return 9;  // reported later
  steps.erase(steps.begin());      // a stamp, not a step
  const double step = upper_median(steps);
  for (const int decimals : {9, 6, 3, 0}) {
    const double step_s = step * std::pow(10.0, decimals - 9);
    if (step_s >= kLeast_s && step_s < kMost_s) return decimals;
  }
  throw BadInput(
      fmt::format("{}: the time step is {}. In each of the units s, ms, us and ns, the sample rate is outside 10 to "
                  "1000 Hz. Add the unit to the column name, as in time_s or 'time [ns]'",
                  file, std::to_string(step)));
}

}  // namespace tumble::scenarios
