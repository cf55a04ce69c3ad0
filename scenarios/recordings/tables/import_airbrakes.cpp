// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "scenarios/recordings/tables/repeated_readings.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kAirbrakesAttribution =
    "AirbrakesV2, NCSU High-Powered Rocketry Club (github.com/NCSU-High-Powered-Rocketry-Club/AirbrakesV2), MIT; ";
constexpr double kAirbrakesStampMax_s = 1e9;
/// Estimators do not bridge gaps longer than kBridgedGap_ns.
constexpr std::int64_t kBridgedGap_ns = 1'000'000'000;

using Columns3 = std::array<std::size_t, 3>;

std::size_t column(const CsvLine& header, const std::string& name) {
  const auto found = std::find(header.fields.begin(), header.fields.end(), name);
  if (found == header.fields.end()) throw BadInput(fmt::format("{}: a column is missing: {}", header.where, name));
  if (std::count(header.fields.begin(), header.fields.end(), name) > 1)
    throw BadInput(fmt::format("{}: two columns have the name {}", header.where, name));
  return static_cast<std::size_t>(found - header.fields.begin());
}

Columns3 columns(const CsvLine& header, const std::string& stem, const std::string& unit) {
  return {column(header, stem + "_x_" + unit), column(header, stem + "_y_" + unit),
          column(header, stem + "_z_" + unit)};
}

Eigen::Vector3d vector(const CsvLine& line, const Columns3& columns, const char* name) {
  return {csv_number(line, columns[0], name), csv_number(line, columns[1], name), csv_number(line, columns[2], name)};
}

std::int64_t stamp_ns(const CsvLine& line, std::size_t column, std::size_t columns) {
  if (line.fields.size() != columns) {
    throw BadInput(fmt::format("{}: this line has {} columns, but the header has {}; the numbers must be equal",
                               line.where, line.fields.size(), columns));
  }
  const double time_s = csv_number(line, column, "timestamp_seconds");
  if (!(time_s >= 0.0 && time_s <= kAirbrakesStampMax_s)) {
    throw BadInput(fmt::format("{}: timestamp_seconds is {}; it must be within 0 and {}", line.where, time_s,
                               kAirbrakesStampMax_s));
  }
  return std::llround(time_s * 1e9);
}

template <class T>
void keep(std::vector<T>& rows, std::size_t first, std::size_t end) {
  if (rows.empty()) return;
  rows = std::vector<T>(rows.begin() + static_cast<std::ptrdiff_t>(first),
                        rows.begin() + static_cast<std::ptrdiff_t>(end));
}

/// Keeps the longest part of the log without a gap, because logs start long before the flight with few samples.
void keep_longest_segment(sim::ImuRecord& imu, std::vector<std::string>& notes) {
  const std::size_t count = imu.time_ns.size();
  std::size_t first = 0, end = 0, gaps = 0;
  for (std::size_t begin = 0, k = 1; k <= count; ++k) {
    if (k < count && imu.time_ns[k] - imu.time_ns[k - 1] <= kBridgedGap_ns) continue;
    if (k - begin > end - first) first = begin, end = k;
    gaps += k < count ? 1 : 0;
    begin = k;
  }
  if (gaps == 0) return;
  notes.push_back(fmt::format(
      "the recording has {} gaps of more than 1 s; the import keeps the longest segment: samples {} to {} of {}", gaps,
      first, end - 1, count));
  keep(imu.time_ns, first, end);
  keep(imu.gyro_rad_s, first, end);
  keep(imu.accel_m_s2, first, end);
  keep(imu.clip_flags, first, end);
  keep(imu.magnetic_field_t, first, end);
}

}  // namespace

bool is_airbrakes(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  return std::getline(stream, line) && line.find("timestamp_seconds") != std::string::npos &&
         line.find("raw_angular_rate_x_deg_per_s") != std::string::npos;
}

Imported import_airbrakes(const std::filesystem::path& path) {
  CsvText text(path, ',');
  CsvLine line;
  text.next(line);
  const std::size_t stamp = column(line, "timestamp_seconds"), count = line.fields.size();
  const Columns3 force = columns(line, "raw_acceleration", "gs");
  const Columns3 rate = columns(line, "raw_angular_rate", "deg_per_s");
  const char* field_name = "magnetic_field_x_microteslas";
  const bool magnetic = std::find(line.fields.begin(), line.fields.end(), field_name) != line.fields.end();
  const Columns3 field = magnetic ? columns(line, "magnetic_field", "microteslas") : Columns3{};
  sim::ImuRecord imu;
  imu.name = "imu";
  std::size_t doubled = 0;
  LeftOut left_out("readings");
  std::vector<std::string> places;
  while (text.next(line)) {
    left_out.guard([&] {
      const std::int64_t time_ns = stamp_ns(line, stamp, count);
      if (!imu.time_ns.empty() && time_ns == imu.time_ns.back()) {
        ++doubled;
        return;
      }
      const Eigen::Vector3d field_t =
          magnetic ? kTeslaPerMicrotesla * vector(line, field, "magnetic_field") : Eigen::Vector3d(0.0, 0.0, 0.0);
      add_reading(line.where, time_ns, scale_of(GyroUnit::deg_s) * vector(line, rate, "raw_angular_rate"),
                  scale_of(AccelUnit::g) * vector(line, force, "raw_acceleration"), imu);
      if (magnetic) imu.magnetic_field_t.push_back(field_t);
      places.push_back(line.where);
    });
  }
  const auto where = [&](std::size_t k) { return places[k]; };
  const std::string bursts = leave_out_faulty(where, nullptr, left_out, imu);
  Imported out;
  for (const std::string& note : {left_out.note(imu.time_ns.size()), bursts}) {
    if (!note.empty()) out.notes.push_back(note);
  }
  keep_longest_segment(imu, out.notes);
  imu.period_ns = 0;  // the period of the longest segment
  finish_readings(path.string(), AccelUnit::g, imu);
  const std::int64_t first_ns = imu.time_ns.front();
  for (std::int64_t& time : imu.time_ns) time -= first_ns;
  if (doubled > 0)
    out.notes.push_back(fmt::format("{} rows have the time stamp of an earlier row and are left out", doubled));
  for (const std::string& note :
       {require_plausible_rates(path.string(), imu, GyroUnit::deg_s), accel_rail_text(imu.accel_m_s2)}) {
    if (!note.empty()) out.notes.push_back(note);
  }
  out.info.attribution = kAirbrakesAttribution + path.filename().string();
  out.info.origin_ns = first_ns;
  out.sensors.imus.push_back(std::move(imu));
  const std::string problem = find_problem(out.sensors);
  if (!problem.empty()) throw BadInput(path.string() + ": " + problem);
  return out;
}

}  // namespace tumble::scenarios
