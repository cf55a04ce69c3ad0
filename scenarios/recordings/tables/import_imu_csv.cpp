// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kSecond_ns = 1000000000;

/// Where the columns stand.
struct Layout {
  std::size_t stamp = 0, stamp_ns = 1;
  bool decimal_stamp = false;  ///< "1617333602.223639727"; else whole seconds, and nanoseconds in a column of their own
  std::array<std::size_t, 3> rate = {8, 9, 10}, force = {12, 13, 14};
  bool has_header = true;
  bool states_units = false;  ///< names such as "fx_m_s2" say what they are in
};

/// Columns that a header-less sensor_msgs/Imu must have.
constexpr std::size_t kColumnsByPlace = 15;

[[noreturn]] void fail(const CsvLine& line, const std::string& what) {
  throw BadInput(line.where + ": " + what);
}

const std::array<std::string, 3> kAxes = {"x", "y", "z"};

/// What `export` writes: each of these once, and nothing else.
const std::vector<std::string> kExported = {"stamp_s",  "stamp_ns", "frame_id", "qx",
                                            "qy",       "qz",       "qw",       "orientation_covariance",
                                            "wx_rad_s", "wy_rad_s", "wz_rad_s", "angular_velocity_covariance",
                                            "fx_m_s2",  "fy_m_s2",  "fz_m_s2",  "linear_acceleration_covariance"};

/// The one column that `fits`; a second one would be another sensor's.
template <class Fits>
std::optional<std::size_t> find_column(const CsvLine& header, const std::string& name, const Fits& fits) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (!fits(header.fields[i])) continue;
    if (found) fail(header, "two columns are called " + name);
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

/// Collects the columns of a header that must all be there.
class Columns {
 public:
  explicit Columns(const CsvLine& header) : header_(header) {}
  void take(const std::optional<std::size_t>& place, const std::string& name, std::size_t& column) {
    if (place)
      column = *place, ++found_;
    else
      missing_ += " " + name;
  }
  /// False when none is there; throws when some are.
  bool complete() const {
    if (found_ == 0) return false;
    if (!missing_.empty()) fail(header_, "columns are missing:" + missing_);
    return true;
  }

 private:
  const CsvLine& header_;
  int found_ = 0;
  std::string missing_;
};

/// ".../header/stamp" and so on, as tools that flatten messages write them.
std::optional<Layout> flattened(const CsvLine& header) {
  Layout layout;
  Columns columns(header);
  columns.take(find_ending(header, "header/stamp"), "header/stamp", layout.stamp);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string rate = "angular_velocity/" + kAxes[axis], force = "linear_acceleration/" + kAxes[axis];
    columns.take(find_ending(header, rate), rate, layout.rate[axis]);
    columns.take(find_ending(header, force), force, layout.force[axis]);
  }
  layout.decimal_stamp = true;
  return columns.complete() ? std::optional(layout) : std::nullopt;
}

/// "wx_rad_s" or "wx", "fx_m_s2", "fx" or "ax", "stamp_s", "sec", "secs" or "s" with "stamp_ns" and so on.
std::optional<Layout> named(const CsvLine& header) {
  Layout layout;
  Columns columns(header);
  columns.take(find_any(header, {"stamp_s", "sec", "secs", "s"}), "stamp_s", layout.stamp);
  columns.take(find_any(header, {"stamp_ns", "nsec", "nsecs", "ns"}), "stamp_ns", layout.stamp_ns);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string rate = "w" + kAxes[i], force = "f" + kAxes[i];
    columns.take(find_any(header, {rate + "_rad_s", rate}), rate + "_rad_s", layout.rate[i]);
    columns.take(find_any(header, {force + "_m_s2", force, "a" + kAxes[i]}), force + "_m_s2", layout.force[i]);
  }
  return columns.complete() ? std::optional(layout) : std::nullopt;
}

/// A header with names of our own export has all of them, each once, and no other.
void require_exported(const CsvLine& header) {
  for (const std::string_view field : header.fields) {
    const std::string name(field);
    if (std::find(kExported.begin(), kExported.end(), name) == kExported.end())
      fail(header, "unknown column '" + name + "'" + suggestion(name, kExported));
  }
  for (const std::string& name : kExported) {
    const auto count = std::count(header.fields.begin(), header.fields.end(), name);
    if (count > 1) fail(header, "two columns are called " + name);
  }
}

/// Names are believed before places; a first line of numbers is a sample, and the columns stand where a plain
/// sensor_msgs/Imu has them.
Layout layout_of(const CsvLine& header) {
  if (is_number(header.fields.front())) {
    Layout layout;
    layout.has_header = false;
    return layout;
  }
  if (std::optional<Layout> layout = flattened(header)) return *layout;
  const auto with_unit = [](std::string_view field) {
    return field == "stamp_s" || field.ends_with("_rad_s") || field.ends_with("_m_s2");
  };
  const bool own = std::any_of(header.fields.begin(), header.fields.end(), with_unit);
  if (own) require_exported(header);
  std::optional<Layout> layout = named(header);
  if (!layout) {
    fail(header,
         "names no column that is known: stamp_s, stamp_ns, wx_rad_s, ..., fx_m_s2, ... (as 'export' writes "
         "them), .../header/stamp, .../angular_velocity/x, ... or none at all");
  }
  layout->states_units = own;
  return *layout;
}

double number(const CsvLine& line, std::size_t column) {
  return csv_number(line, column, std::to_string(column));
}

std::int64_t whole_number(const CsvLine& line, std::size_t column, std::int64_t largest) {
  const double value = number(line, column);
  if (value != std::floor(value) || value < 0.0 || value > static_cast<double>(largest)) {
    fail(line, "column " + std::to_string(column) + " must be a whole number from 0 to " + std::to_string(largest));
  }
  return static_cast<std::int64_t>(value);
}

Eigen::Vector3d vector(const CsvLine& line, const std::array<std::size_t, 3>& columns) {
  return {number(line, columns[0]), number(line, columns[1]), number(line, columns[2])};
}

/// A decimal number of seconds, without the rounding of a double.
std::int64_t decimal_ns(const CsvLine& line, std::size_t column) {
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
std::int64_t stamp_ns(const CsvLine& line, const Layout& layout) {
  if (layout.decimal_stamp) return decimal_ns(line, layout.stamp);
  return whole_number(line, layout.stamp, 9'000'000'000) * kSecond_ns +
         whole_number(line, layout.stamp_ns, kSecond_ns - 1);
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device, AccelUnit unit,
                        GyroUnit gyro_unit) {
  CsvText text(path, ',');
  CsvLine line;
  text.next(line);
  const Layout layout = layout_of(line);
  const std::size_t columns = line.fields.size();
  if (layout.states_units && (unit != AccelUnit::m_s2 || gyro_unit != GyroUnit::rad_s))
    fail(line, "its names say rad/s and m/s^2, another unit is asked for");
  if (!layout.has_header && columns < kColumnsByPlace) {
    fail(line, "has " + std::to_string(columns) + " columns and no header, needs " + std::to_string(kColumnsByPlace));
  }
  sim::ImuRecord imu = without_readings(device);
  const auto add = [&] {
    if (line.fields.size() != columns) {
      fail(line, "has " + std::to_string(line.fields.size()) + " columns, the first line " + std::to_string(columns) +
                     "; must be equal");
    }
    add_reading(line.where, stamp_ns(line, layout), scale_of(gyro_unit) * vector(line, layout.rate),
                scale_of(unit) * vector(line, layout.force), imu);
  };
  if (!layout.has_header) add();
  while (text.next(line)) add();
  finish_readings(path.string(), unit, imu);
  Imported out;
  for (const std::string& remark : {even_out_stamps(imu), require_plausible_rates(path.string(), imu, gyro_unit)}) {
    if (!remark.empty()) out.notes.push_back(remark);
  }
  const std::int64_t first_ns = imu.time_ns.front();
  for (std::int64_t& time : imu.time_ns) time -= first_ns;
  out.info.attribution =
      "imported from " + path.filename().string() + ", first stamp " + std::to_string(first_ns) + " ns";
  out.info.origin_ns = first_ns;
  out.sensors.imus.push_back(std::move(imu));
  return out;
}

}  // namespace tumble::scenarios
