// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/logger_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

struct Name {
  std::string quantity, unit;
};

template <class Value>
using UnitNames = std::vector<std::pair<std::string_view, Value>>;

const std::vector<std::string_view> kTimes = {"t",     "time", "timestamp", "timestamps",    "sampletime",
                                              "stamp", "ts",   "elapsed",   "secondselapsed"};
constexpr const char* kExample = "time=NAME,gyro=X,Y,Z,accel=X,Y,Z";

const std::vector<std::string_view> kSecondTimes = {"elapsed", "secondselapsed"};
const std::vector<std::string_view> kRates = {"g",           "gyro", "gyr",    "gyroscope", "angularvelocity",
                                              "angularrate", "w",    "omega",  "angvel",    "rate",
                                              "wrss",        "rot",  "gyrorad"};
const std::vector<std::string_view> kForces = {
    "a", "acc",           "accel", "accelerometer", "acceleration",    "linearacceleration",
    "f", "specificforce", "arss",  "linacc",        "accelerometerms2"};
const std::vector<std::string_view> kIds = {"i", "id", "instance", "imuid", "sensorid"};

/// The time column SampleTimeFine of Xsens devices counts units of 0.1 ms.
const UnitNames<int> kTimeUnits = {{"s", 9},    {"sec", 9},  {"secs", 9}, {"seconds", 9},
                                   {"ms", 6},   {"msec", 6}, {"fine", 5}, {"us", 3},
                                   {"usec", 3}, {"ns", 0},   {"nsec", 0}, {"nanoseconds", 0}};
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

Name split_brackets(std::string_view field) {
  const std::size_t open = field.find_first_of("[(");
  if (open == std::string_view::npos) return {letters(field), ""};
  const std::string quantity = letters(field.substr(0, open)), unit = letters(field.substr(open));
  if (unit == "0" || unit == "1" || unit == "2") return {quantity + "xyz"[unit.front() - '0'], ""};
  return {quantity, unit};
}

template <class Value, class IsQuantity>
Name split_suffix(std::string_view field, const UnitNames<Value>& units, const IsQuantity& is_quantity) {
  for (std::size_t at = field.find('_'); at != std::string_view::npos; at = field.find('_', at + 1)) {
    Name name{letters(field.substr(0, at)), letters(field.substr(at))};
    if (is_quantity(name.quantity) && value_of(units, name.unit)) return name;
  }
  Name name = split_brackets(field);
  if (is_quantity(name.quantity)) return name;
  constexpr std::size_t kShortest = 2;  // plural "s" in "stamps"
  for (const auto& [unit, value] : units) {
    const std::string_view whole = name.quantity;
    if (unit.size() < kShortest || !whole.ends_with(unit)) continue;
    const std::string_view quantity = whole.substr(0, whole.size() - unit.size());
    if (is_quantity(quantity)) return {std::string(quantity), std::string(unit)};
  }
  return name;
}

struct NamedAxis {
  std::size_t axis = 0;
  std::string number;
};

std::string take_number(std::string_view& text, bool from_end) {
  std::string digits;
  while (!text.empty() && std::isdigit(static_cast<unsigned char>(from_end ? text.back() : text.front())) != 0) {
    digits.insert(from_end ? digits.begin() : digits.end(), from_end ? text.back() : text.front());
    from_end ? text.remove_suffix(1) : text.remove_prefix(1);
  }
  return digits;
}

std::optional<NamedAxis> axis_of(const std::vector<std::string_view>& names, std::string_view quantity) {
  NamedAxis out;
  if (quantity.starts_with("imu")) {
    quantity.remove_prefix(3);
    out.number = take_number(quantity, false);
  }
  if (quantity.size() < 2) return std::nullopt;
  out.axis = std::string_view("xyz").find(quantity.back());
  if (out.axis == std::string_view::npos) return std::nullopt;
  quantity.remove_suffix(1);
  if (is_one_of(names, quantity)) return out;
  out.number += take_number(quantity, true);
  return is_one_of(names, quantity) ? std::optional(out) : std::nullopt;
}

template <class Value>
std::optional<Value> unit_in(std::string_view field, const UnitNames<Value>& units) {
  if (const std::size_t open = field.find_first_of("[("); open != std::string_view::npos)
    return value_of(units, letters(field.substr(open)));
  for (std::size_t at = field.find('_'); at != std::string_view::npos; at = field.find('_', at + 1))
    if (const auto unit = value_of(units, letters(field.substr(at)))) return unit;
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(const CsvLine& header) : header_(header), taken_(header.fields.size(), false) {}

  std::optional<int> time(std::size_t& column) {
    const auto is_time = [](std::string_view quantity) { return is_one_of(kTimes, quantity); };
    std::optional<std::size_t> found, second;
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const Name name = split_suffix(header_.fields[i], kTimeUnits, is_time);
      if (!is_time(name.quantity)) continue;
      const bool weak = header_.fields[i] == "T" || is_one_of(kSecondTimes, name.quantity);
      std::optional<std::size_t>& place = weak ? second : found;
      if (place && !weak)
        fail(fmt::format("two columns contain time stamps, '{}' and '{}'; choose one of them with --columns",
                         text(*place), text(i)));
      place = i;
    }
    if (!found) found = second;
    if (!found) {
      missing_ += " time";
      return std::nullopt;
    }
    take(*found, column);
    return unit_of(kTimeUnits, split_suffix(header_.fields[*found], kTimeUnits, is_time), *found);
  }

  template <class Unit>
  std::optional<Unit> triad(const std::vector<std::string_view>& names, const UnitNames<Unit>& units,
                            const char* called, std::array<std::size_t, 3>& columns) {
    std::array<std::optional<std::size_t>, 3> found;
    std::array<std::optional<Unit>, 3> stated;
    const auto is_axis = [&](std::string_view quantity) { return axis_of(names, quantity).has_value(); };
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const Name name = split_suffix(header_.fields[i], units, is_axis);
      const std::optional<NamedAxis> named = axis_of(names, name.quantity);
      if (!named) continue;
      const std::size_t axis = named->axis;
      if (!number_) number_ = named->number;
      if (*number_ != named->number) fail_of_several(called, named->number);
      if (found[axis])
        fail(fmt::format("two columns contain the {}'s axis {}: '{}' and '{}'; choose the columns with --columns",
                         called, "xyz"[axis], text(*found[axis]), text(i)));
      stated[axis] = unit_of(units, name, i);
      found[axis] = i;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (found[axis]) take(*found[axis], columns[axis]);
      if (!found[axis]) missing_ += std::string(" ") + called + "_" + "xyz"[axis];
    }
    if (stated[0] != stated[1] || stated[0] != stated[2])
      fail(fmt::format("the axes of the {} have different units; they must have the same unit", called));
    return stated[0];
  }

  bool complete(std::size_t readings) const {
    if (readings == 0) return false;
    if (!missing_.empty())
      fail(fmt::format(
          "the table lacks these columns:{}; if other columns contain the values, choose them with --columns {}",
          missing_, kExample));
    return true;
  }
  std::optional<std::size_t> id() {
    for (std::size_t i = 0; i < header_.fields.size(); ++i)
      if (is_one_of(kIds, letters(header_.fields[i]))) return i;
    return std::nullopt;
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
  [[noreturn]] void fail_of_several(const char* called, const std::string& number) const {
    fail(fmt::format(
        "the {} columns belong to several IMUs, '{}' and '{}'; choose the columns of one IMU with --columns {}", called,
        *number_, number, kExample));
  }
  std::string text(std::size_t i) const { return std::string(header_.fields[i]); }
  void take(std::size_t from, std::size_t& column) {
    taken_[from] = true;
    column = from;
  }
  template <class Unit>
  std::optional<Unit> unit_of(const UnitNames<Unit>& units, const Name& name, std::size_t i) const {
    if (name.unit.empty()) return std::nullopt;
    std::optional<Unit> unit = value_of(units, name.unit);
    if (!unit)
      fail(
          fmt::format("the unit in the name of column '{}' is unknown; choose the columns with --columns and state the "
                      "unit with an option",
                      text(i)));
    return unit;
  }

  const CsvLine& header_;
  std::vector<bool> taken_;
  std::string missing_;
  std::optional<std::string> number_;
};

std::vector<std::string> names_of(const std::string& choice, const std::string& quantity) {
  std::vector<std::string> names;
  std::string current;
  for (std::string_view rest = choice; !rest.empty();) {
    std::string_view word = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    for (const std::string_view key : {"time=", "gyro=", "accel="}) {
      if (!word.starts_with(key)) continue;
      current = key.substr(0, key.size() - 1);
      word.remove_prefix(key.size());
      break;
    }
    if (current.empty())
      throw BadInput(fmt::format("the entry '{}' of --columns must begin with time=, gyro= or accel=", word));
    if (current == quantity) names.emplace_back(word);
  }
  return names;
}

std::size_t column_of(const LoggedTable& table, const std::string& name) {
  const std::vector<std::string_view>& fields = table.header().fields;
  const auto count = table.has_header() ? std::count(fields.begin(), fields.end(), name) : 0;
  if (count == 1) return static_cast<std::size_t>(std::find(fields.begin(), fields.end(), name) - fields.begin());
  std::size_t position = 0;
  if (count == 0 && read_number(name, position) && position < fields.size()) return position;
  throw BadInput(fmt::format(
      "{}: --columns names '{}', but {} of the {} columns have this name; exactly one column must have this name. {}{}",
      table.header().where, name, count, fields.size(),
      table.has_header() ? "Names: " : "The table has no column names; write the number of the column, counted from 0",
      table.has_header() ? fmt::format("{}", fmt::join(fields, " ")) : ""));
}

void require_count(const std::string& quantity, std::size_t count, std::size_t least, std::size_t most) {
  if (count >= least && count <= most) return;
  throw BadInput(
      fmt::format("--columns: {} has {} columns; it must have {}; for example "
                  "time=t,gyro=gx,gy,gz,accel=ax,ay,az",
                  quantity, count, most == 3 ? "3" : "1 (2 with nanoseconds)"));
}

template <class Unit>
std::optional<Unit> choose_triad(const LoggedTable& table, const std::string& choice, const char* quantity,
                                 const UnitNames<Unit>& units, std::array<std::size_t, 3>& columns) {
  const std::vector<std::string> names = names_of(choice, quantity);
  require_count(quantity, names.size(), 3, 3);
  for (std::size_t axis = 0; axis < 3; ++axis) columns[axis] = column_of(table, names[axis]);
  return table.has_header() ? unit_in(table.header().fields[columns[0]], units) : std::nullopt;
}

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
  columns.id = reader.id();
  columns.left_out = reader.others();
  return columns;
}

ImuColumns chosen_columns(const LoggedTable& table, const std::string& choice) {
  ImuColumns columns;
  columns.gyro_unit = choose_triad(table, choice, "gyro", kRateUnits, columns.rate);
  columns.accel_unit = choose_triad(table, choice, "accel", kForceUnits, columns.force);
  const std::vector<std::string> times = names_of(choice, "time");
  require_count("time", times.size(), 1, 2);
  columns.stamp = column_of(table, times.front());
  if (times.size() == 2) {
    columns.stamp_ns = column_of(table, times.back());
    return columns;
  }
  columns.stamp_form = StampForm::decimal;
  if (table.has_header()) {
    const std::string_view name = table.header().fields[columns.stamp];
    columns.stamp_decimals = unit_in(name, kTimeUnits);
    const Name split = split_suffix(name, kTimeUnits, [](std::string_view each) { return is_one_of(kTimes, each); });
    if (!columns.stamp_decimals) columns.stamp_decimals = value_of(kTimeUnits, split.unit);
  }
  return columns;
}

}  // namespace tumble::scenarios
