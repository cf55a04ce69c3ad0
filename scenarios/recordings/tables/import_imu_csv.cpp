// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/tables/imu_columns.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"

namespace tumble::scenarios {

namespace {

/// Returns the unit in the column names, else the unit that the caller states. Throws BadInput if a unit that the
/// caller states contradicts the names.
template <class Unit>
Unit chosen(std::optional<Unit> stated, Unit asked, Unit usual, const CsvLine& header) {
  if (!stated || *stated == asked) return asked;
  if (asked == usual) return *stated;
  throw BadInput(header.where + ": the column names state rad/s and m/s^2, but another unit was given");
}

Eigen::Vector3d vector(const CsvLine& line, const std::array<std::size_t, 3>& columns) {
  const auto number = [&](std::size_t column) { return csv_number(line, column, std::to_string(column)); };
  return {number(columns[0]), number(columns[1]), number(columns[2])};
}

std::string unit_of_stamps(int decimals) {
  return decimals == 9 ? "s" : decimals == 6 ? "ms" : decimals == 3 ? "us" : "ns";
}

/// Notes the interpretation of ambiguous column names.
void say_columns(const ImuColumns& columns, bool stated, std::vector<std::string>& notes) {
  if (columns.stamp_form != StampForm::decimal) return;
  if (!stated)
    notes.push_back(
        fmt::format("times are read in {}, from the size of their steps", unit_of_stamps(*columns.stamp_decimals)));
  if (columns.gyro_unit == GyroUnit::deg_s) notes.push_back("rates are read in deg/s, from the column names");
  if (columns.accel_unit == AccelUnit::g) notes.push_back("specific force is read in g, from the column names");
  std::string others;
  for (const std::string& name : columns.left_out) others += (others.empty() ? "" : ", ") + name;
  if (!others.empty()) notes.push_back("ignored columns: " + others);
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device, AccelUnit unit,
                        GyroUnit gyro_unit) {
  CsvText text(path);
  CsvLine line;
  text.next(line);
  ImuColumns columns = imu_columns(line);
  unit = chosen(columns.accel_unit, unit, AccelUnit::m_s2, line);
  gyro_unit = chosen(columns.gyro_unit, gyro_unit, GyroUnit::rad_s, line);
  Imported out;
  if (columns.stamp_form == StampForm::decimal) {
    const bool stated = columns.stamp_decimals.has_value();
    if (!stated) columns.stamp_decimals = decimals_by_step(text, columns.stamp, line.fields.size(), path.string());
    say_columns(columns, stated, out.notes);
  }
  sim::ImuRecord imu = without_readings(device);
  const std::size_t count = line.fields.size();
  LeftOut left_out("readings");
  std::vector<std::string> places;
  const auto add = [&] {
    left_out.guard([&] {
      require_width(line, count);
      add_reading(line.where, stamp_ns(line, columns), scale_of(gyro_unit) * vector(line, columns.rate),
                  scale_of(unit) * vector(line, columns.force), imu);
      places.push_back(line.where.substr(path.string().size()));
    });
  };
  if (!columns.has_header) add();
  while (text.next(line)) add();
  const auto where = [&](std::size_t k) { return path.string() + places[k]; };
  const std::string bursts = leave_out_faulty(where, nullptr, left_out, imu);
  finish_readings(path.string(), unit, imu);
  const std::string evened = even_out_stamps(imu);
  for (const std::string& remark :
       {left_out.note(imu.time_ns.size()), bursts, evened, gaps_text(imu), rates_text(path.string(), imu, gyro_unit)}) {
    if (!remark.empty()) out.notes.push_back(remark);
  }
  const std::int64_t first_ns = imu.time_ns.front();
  for (std::int64_t& time : imu.time_ns) time -= first_ns;
  out.info.attribution = fmt::format("imported from {}, first time stamp {} ns", path.filename().string(), first_ns);
  out.info.origin_ns = first_ns;
  out.sensors.imus.push_back(std::move(imu));
  return out;
}

}  // namespace tumble::scenarios
