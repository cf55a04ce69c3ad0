// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kLeastColumns = 15;
constexpr std::int64_t kSecond_ns = 1000000000;

/// One line of the file and where it stands.
struct Line {
  std::string where;
  std::vector<std::string_view> fields;
};

[[noreturn]] void fail(const Line& line, const std::string& what) {
  throw BadInput(line.where + ": " + what);
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

Eigen::Vector3d vector(const Line& line, std::size_t column) {
  return {number(line, column), number(line, column + 1), number(line, column + 2)};
}

/// Since the epoch; stamps up to the year 2262 fit.
std::int64_t stamp_ns(const Line& line) {
  return whole_number(line, 0, 9'000'000'000) * kSecond_ns + whole_number(line, 1, kSecond_ns - 1);
}

std::int64_t median_step(const std::vector<std::int64_t>& times) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

void append_sample(const Line& line, std::int64_t& first_ns, sim::ImuRecord& imu) {
  const std::int64_t stamp = stamp_ns(line);
  if (imu.time_ns.empty()) first_ns = stamp;
  const std::int64_t time_ns = stamp - first_ns;
  if (!imu.time_ns.empty() && time_ns <= imu.time_ns.back()) {
    fail(line, "stamp does not rise: " + std::to_string(time_ns) + " ns after the first, the one before " +
                   std::to_string(imu.time_ns.back()));
  }
  imu.time_ns.push_back(time_ns);
  imu.gyro_rad_s.push_back(vector(line, 8));
  imu.accel_m_s2.push_back(vector(line, 12));
  imu.clip_flags.push_back(0);
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(path)) throw BadInput(path.string() + ": no such file");
  std::string text;
  if (!std::getline(stream, text)) throw BadInput(path.string() + ": is empty");
  const std::size_t columns = split(text).size();
  sim::ImuRecord imu = device;
  for (auto* rows : {&imu.gyro_rad_s, &imu.accel_m_s2}) rows->clear();
  imu.time_ns.clear();
  imu.clip_flags.clear();
  std::int64_t first_ns = 0;
  for (int number_of_line = 2; std::getline(stream, text); ++number_of_line) {
    const Line line{path.string() + ":" + std::to_string(number_of_line), split(text)};
    if (line.fields.size() < kLeastColumns || line.fields.size() != columns) {
      fail(line, "has " + std::to_string(line.fields.size()) + " columns, the header " + std::to_string(columns) +
                     "; must be equal and at least " + std::to_string(kLeastColumns));
    }
    append_sample(line, first_ns, imu);
  }
  if (stream.bad()) throw BadInput(path.string() + ": cannot be read");
  if (imu.time_ns.size() < 2)
    throw BadInput(path.string() + ": holds " + std::to_string(imu.time_ns.size()) + " samples, needs 2");
  imu.period_ns = median_step(imu.time_ns);
  Imported out;
  out.info.attribution =
      "imported from " + path.filename().string() + ", first stamp " + std::to_string(first_ns) + " ns";
  out.sensors.imus.push_back(std::move(imu));
  return out;
}

}  // namespace tumble::scenarios
