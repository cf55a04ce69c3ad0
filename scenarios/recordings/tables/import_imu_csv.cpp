// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kSecond_ns = 1000000000;

/// Where the columns stand.
struct Layout {
  std::size_t stamp = 0;
  bool decimal_stamp = false;  ///< "1617333602.223639727"; else whole seconds, and nanoseconds in the next column
  std::array<std::size_t, 3> rate = {8, 9, 10}, force = {12, 13, 14};
  std::size_t least = 15;  ///< columns that a line must have
};

/// One line of the file and where it stands.
struct Line {
  std::string where;
  std::vector<std::string_view> fields;
};

[[noreturn]] void fail(const Line& line, const std::string& what) {
  throw BadInput(line.where + ": " + what);
}

/// The column whose name ends in `name`; a second one would be another sensor's.
std::optional<std::size_t> find_column(const Line& header, const std::string& name) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (!header.fields[i].ends_with(name)) continue;
    if (found) fail(header, "two columns are called " + name);
    found = i;
  }
  return found;
}

/// By name when one of them is there, and then all must be; else the places of a plain sensor_msgs/Imu.
Layout layout_of(const Line& header) {
  Layout layout;
  std::size_t found = 0;
  std::string missing;
  const auto take = [&](const std::string& name, std::size_t& column) {
    const std::optional<std::size_t> place = find_column(header, name);
    if (place)
      column = *place, ++found;
    else
      missing += " " + name;
  };
  take("header/stamp", layout.stamp);
  const std::array<std::string, 3> axes = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    take("angular_velocity/" + axes[axis], layout.rate[axis]);
    take("linear_acceleration/" + axes[axis], layout.force[axis]);
  }
  if (found == 0) return {};
  if (!missing.empty()) fail(header, "columns are missing:" + missing);
  layout.decimal_stamp = true;
  layout.least = header.fields.size();
  return layout;
}

std::vector<std::string_view> split(std::string_view text) {
  if (text.ends_with('\r')) text.remove_suffix(1);
  std::vector<std::string_view> fields;
  for (std::size_t end = text.find(','); end != std::string_view::npos; end = text.find(',')) {
    fields.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  fields.push_back(text);
  return fields;
}

double number(const Line& line, std::size_t column) {
  std::string_view text = line.fields[column];
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string place = "column " + std::to_string(column) + " ";
  if (error != std::errc() || end != text.data() + text.size())
    fail(line, place + "must be a number, is '" + std::string(text) + "'");
  if (!std::isfinite(value)) fail(line, place + "is not finite");
  return value;
}

std::int64_t whole_number(const Line& line, std::size_t column, std::int64_t largest) {
  const double value = number(line, column);
  if (value != std::floor(value) || value < 0.0 || value > static_cast<double>(largest)) {
    fail(line, "column " + std::to_string(column) + " must be a whole number from 0 to " + std::to_string(largest));
  }
  return static_cast<std::int64_t>(value);
}

Eigen::Vector3d vector(const Line& line, const std::array<std::size_t, 3>& columns) {
  return {number(line, columns[0]), number(line, columns[1]), number(line, columns[2])};
}

/// A decimal number of seconds, without the rounding of a double.
std::int64_t decimal_ns(const Line& line, std::size_t column) {
  const std::string_view text = line.fields[column];
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view part = text.substr(std::min(point + 1, text.size()));
  std::int64_t seconds = 0, fraction_ns = 0;
  const auto all_digits = [](std::string_view digits) {
    return std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  if (point == 0 || point > 10 || part.size() > 9 || !all_digits(text.substr(0, point)) || !all_digits(part)) {
    fail(line, "column " + std::to_string(column) + " must be seconds with at most nine decimals, is '" +
                   std::string(text) + "'");
  }
  std::from_chars(text.data(), text.data() + point, seconds);
  std::string digits(part);
  digits.resize(9, '0');
  std::from_chars(digits.data(), digits.data() + digits.size(), fraction_ns);
  return seconds * kSecond_ns + fraction_ns;
}

/// Since the epoch; stamps up to the year 2255 fit.
std::int64_t stamp_ns(const Line& line, const Layout& layout) {
  if (layout.decimal_stamp) return decimal_ns(line, layout.stamp);
  return whole_number(line, layout.stamp, 9'000'000'000) * kSecond_ns +
         whole_number(line, layout.stamp + 1, kSecond_ns - 1);
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device, AccelUnit unit) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(path)) throw BadInput(path.string() + ": no such file");
  std::string text;
  if (!std::getline(stream, text)) throw BadInput(path.string() + ": is empty");
  const std::string header_text = text;
  const Line header{path.string() + ":1", split(header_text)};
  const Layout layout = layout_of(header);
  const std::size_t columns = header.fields.size();
  sim::ImuRecord imu = without_readings(device);
  for (int number_of_line = 2; std::getline(stream, text); ++number_of_line) {
    const Line line{path.string() + ":" + std::to_string(number_of_line), split(text)};
    if (line.fields.size() < layout.least || line.fields.size() != columns) {
      fail(line, "has " + std::to_string(line.fields.size()) + " columns, the header " + std::to_string(columns) +
                     "; must be equal and at least " + std::to_string(layout.least));
    }
    add_reading(line.where, stamp_ns(line, layout), vector(line, layout.rate),
                scale_of(unit) * vector(line, layout.force), imu);
  }
  if (stream.bad()) throw BadInput(path.string() + ": cannot be read");
  finish_readings(path.string(), unit, imu);
  const std::int64_t first_ns = imu.time_ns.front();
  for (std::int64_t& time : imu.time_ns) time -= first_ns;
  Imported out;
  out.info.attribution =
      "imported from " + path.filename().string() + ", first stamp " + std::to_string(first_ns) + " ns";
  out.info.origin_ns = first_ns;
  out.sensors.imus.push_back(std::move(imu));
  return out;
}

}  // namespace tumble::scenarios
