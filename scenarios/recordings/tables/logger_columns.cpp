// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/logger_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

/// A column name and its unit, both in lower case without separators.
struct Name {
  std::string quantity, unit;
};

template <class Value>
using UnitNames = std::vector<std::pair<std::string_view, Value>>;

const std::vector<std::string_view> kTimes = {"t",     "time", "timestamp", "timestamps",
                                              "stamp", "ts",   "elapsed",   "secondselapsed"};
const std::vector<std::string_view> kRates = {
    "g", "gyro", "gyr", "gyroscope", "angularvelocity", "angularrate", "w", "omega", "angvel", "rate", "wrss", "rot"};
const std::vector<std::string_view> kForces = {
    "a", "acc", "accel", "accelerometer", "acceleration", "linearacceleration", "f", "specificforce", "arss", "linacc"};

const UnitNames<int> kTimeUnits = {{"s", 9},  {"sec", 9},  {"secs", 9}, {"seconds", 9}, {"ms", 6},         {"msec", 6},
                                   {"us", 3}, {"usec", 3}, {"ns", 0},   {"nsec", 0},    {"nanoseconds", 0}};
const UnitNames<GyroUnit> kRateUnits = {
    {"rads", GyroUnit::rad_s},   {"radps", GyroUnit::rad_s}, {"rads1", GyroUnit::rad_s},
    {"radsec", GyroUnit::rad_s}, {"degs", GyroUnit::deg_s},  {"dps", GyroUnit::deg_s},
    {"degps", GyroUnit::deg_s},  {"degs1", GyroUnit::deg_s}, {"degsec", GyroUnit::deg_s}};
const UnitNames<AccelUnit> kForceUnits = {{"ms2", AccelUnit::m_s2},
                                          {"mss", AccelUnit::m_s2},
                                          {"mps2", AccelUnit::m_s2},
                                          {"g", AccelUnit::g},
                                          {"gs", AccelUnit::g}};

std::string letters(std::string_view text) {
  constexpr std::string_view kSquare = "\xC2\xB2", kDegree = "\xC2\xB0";
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (text.substr(i).starts_with(kSquare)) out += '2';
    if (text.substr(i).starts_with(kDegree)) out += "deg";
    if (std::isalnum(c) != 0) out += static_cast<char>(std::tolower(c));
  }
  return out;
}

template <class Value>
std::optional<Value> value_of(const UnitNames<Value>& names, std::string_view name) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& each) { return each.first == name; });
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

bool is_one_of(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Splits names with the unit in brackets: "gx [deg/s]", "gx (deg/s)".
Name split_brackets(std::string_view field) {
  const std::size_t open = field.find_first_of("[(");
  if (open == std::string_view::npos) return {letters(field), ""};
  return {letters(field.substr(0, open)), letters(field.substr(open))};
}

/// Splits names such as "time_ms" and "gyro_x_deg_s", with the unit after an underscore that follows the axis.
template <class Value, class IsQuantity>
Name split_suffix(std::string_view field, const UnitNames<Value>& units, const IsQuantity& is_quantity) {
  for (std::size_t at = field.find('_'); at != std::string_view::npos; at = field.find('_', at + 1)) {
    Name name{letters(field.substr(0, at)), letters(field.substr(at))};
    if (is_quantity(name.quantity) && value_of(units, name.unit)) return name;
  }
  return split_brackets(field);
}

/// Returns the axis (0 to 2) if the quantity is one of `names`, with or without the prefix "imu".
std::optional<std::size_t> axis_of(const std::vector<std::string_view>& names, std::string_view quantity) {
  if (quantity.starts_with("imu")) quantity.remove_prefix(3);
  if (quantity.size() < 2 || !is_one_of(names, quantity.substr(0, quantity.size() - 1))) return std::nullopt;
  const std::size_t axis = std::string_view("xyz").find(quantity.back());
  return axis == std::string_view::npos ? std::nullopt : std::optional(axis);
}

/// Takes the columns of one quantity from a header.
class HeaderReader {
 public:
  explicit HeaderReader(const CsvLine& header) : header_(header), taken_(header.fields.size(), false) {}

  std::optional<int> time(std::size_t& column) {
    const auto is_time = [](std::string_view quantity) { return is_one_of(kTimes, quantity); };
    std::optional<std::size_t> found;
    std::optional<int> decimals;
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const Name name = split_suffix(header_.fields[i], kTimeUnits, is_time);
      if (!is_time(name.quantity)) continue;
      if (found) fail(fmt::format("two columns are time stamps: '{}' and '{}'", text(*found), text(i)));
      decimals = unit_of(kTimeUnits, name, i);
      found = i;
    }
    if (found) take(*found, column);
    if (!found) missing_ += " time";
    return decimals;
  }

  template <class Unit>
  std::optional<Unit> triad(const std::vector<std::string_view>& names, const UnitNames<Unit>& units,
                            const char* called, std::array<std::size_t, 3>& columns) {
    std::array<std::optional<std::size_t>, 3> found;
    std::array<std::optional<Unit>, 3> stated;
    const auto is_axis = [&](std::string_view quantity) { return axis_of(names, quantity).has_value(); };
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const Name name = split_suffix(header_.fields[i], units, is_axis);
      const std::optional<std::size_t> axis = axis_of(names, name.quantity);
      if (!axis) continue;
      if (found[*axis])
        fail(fmt::format("two columns are the {}'s {}: '{}' and '{}'", called, "xyz"[*axis], text(*found[*axis]),
                         text(i)));
      stated[*axis] = unit_of(units, name, i);
      found[*axis] = i;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (found[axis]) take(*found[axis], columns[axis]);
      if (!found[axis]) missing_ += std::string(" ") + called + "_" + "xyz"[axis];
    }
    if (stated[0] != stated[1] || stated[0] != stated[2])
      fail(fmt::format("the axes of the {} have different units", called));
    return stated[0];
  }

  /// Returns false if only a time column is known; throws BadInput if a column is missing.
  bool complete(std::size_t readings) const {
    if (readings == 0) return false;
    if (!missing_.empty()) fail("missing columns:" + missing_);
    return true;
  }
  std::size_t taken() const { return static_cast<std::size_t>(std::count(taken_.begin(), taken_.end(), true)); }
  std::vector<std::string> others() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (!taken_[i]) names.push_back(text(i));
    }
    return names;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw BadInput(header_.where + ": " + what); }
  std::string text(std::size_t i) const { return std::string(header_.fields[i]); }
  void take(std::size_t from, std::size_t& column) {
    taken_[from] = true;
    column = from;
  }
  template <class Unit>
  std::optional<Unit> unit_of(const UnitNames<Unit>& units, const Name& name, std::size_t i) const {
    if (name.unit.empty()) return std::nullopt;
    std::optional<Unit> unit = value_of(units, name.unit);
    if (!unit) fail(fmt::format("column '{}' has an unknown unit", text(i)));
    return unit;
  }

  const CsvLine& header_;
  std::vector<bool> taken_;
  std::string missing_;
};

}  // namespace

std::optional<ImuColumns> logger_columns(const CsvLine& header) {
  ImuColumns columns;
  columns.stamp_form = StampForm::decimal;
  HeaderReader reader(header);
  columns.gyro_unit = reader.triad(kRates, kRateUnits, "gyro", columns.rate);
  columns.accel_unit = reader.triad(kForces, kForceUnits, "accel", columns.force);
  const std::size_t readings = reader.taken();
  columns.stamp_decimals = reader.time(columns.stamp);
  if (!reader.complete(readings)) return std::nullopt;
  columns.left_out = reader.others();
  return columns;
}

}  // namespace tumble::scenarios
