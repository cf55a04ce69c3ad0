// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/imu_columns.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "scenarios/recordings/tables/logged_table.hpp"
#include "scenarios/recordings/tables/logger_columns.hpp"

namespace tumble::scenarios {

namespace {

template <class Unit>
Unit chosen(std::optional<Unit> stated, Unit asked, Unit usual, const CsvLine& header) {
  if (!stated || *stated == asked) return asked;
  if (asked == usual) return *stated;
  throw BadInput(
      fmt::format("{}: the column names state rad/s and m/s^2, but an option states another unit; remove the option",
                  header.where));
}

Eigen::Vector3d vector(const CsvLine& line, const std::array<std::size_t, 3>& columns) {
  const auto number = [&](std::size_t column) { return csv_number(line, column, std::to_string(column)); };
  return {number(columns[0]), number(columns[1]), number(columns[2])};
}

std::string unit_of_stamps(int decimals) {
  return decimals == 9 ? "s" : decimals == 6 ? "ms" : decimals == 3 ? "us" : "ns";
}

void say_columns(const ImuColumns& columns, bool stated, std::vector<std::string>& notes) {
  if (columns.stamp_form != StampForm::decimal) return;
  if (!stated)
    notes.push_back(fmt::format("the import reads time stamps in {}, because this unit gives a plausible time step",
                                unit_of_stamps(*columns.stamp_decimals)));
  if (columns.gyro_unit == GyroUnit::deg_s)
    notes.push_back("the import reads angular rates in deg/s, as stated in the column names");
  if (columns.accel_unit == AccelUnit::g)
    notes.push_back("the import reads the specific force in g, as stated in the column names");
  std::string others;
  for (const std::string& name : columns.left_out) others += (others.empty() ? "" : ", ") + name;
  if (!others.empty()) notes.push_back("ignored columns: " + others);
}

/// A column with more than eight different numbers contains row numbers and not IMU numbers.
std::string keep_one_imu(LoggedTable& table, std::size_t id) {
  constexpr std::size_t kImusMax = 8;
  std::map<std::string, std::size_t> rows;
  std::string first;
  CsvLine line;
  while (rows.size() <= kImusMax && table.next_sound(line)) {
    if (rows.empty()) first = line.fields[id];
    ++rows[std::string(line.fields[id])];
  }
  table.restart();
  if (rows.size() < 2 || rows.size() > kImusMax) return "";
  const std::string name(table.header().fields[id]);
  std::string others;
  for (const auto& [number, count] : rows)
    if (number != first) others += fmt::format("{}{} ({} rows)", others.empty() ? "" : ", ", number, count);
  table.keep(id, first);
  return fmt::format(
      "column '{}' contains the numbers of several IMUs; the import reads the rows of IMU {} and leaves out: {}", name,
      first, others);
}

sim::ImuRecord readings_of(LoggedTable& table, const ImuColumns& columns, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit, LeftOut& left_out, std::vector<std::string>& places) {
  sim::ImuRecord imu = without_readings(device);
  CsvLine line;
  for (bool more = true; more;) {
    left_out.guard([&] {
      more = table.next(line);
      if (!more) return;
      add_reading(line.where, stamp_ns(line, columns), scale_of(gyro_unit) * vector(line, columns.rate),
                  scale_of(unit) * vector(line, columns.force), imu);
      places.push_back(line.where);
    });
  }
  return imu;
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device, AccelUnit unit,
                        GyroUnit gyro_unit, const std::string& choice) {
  LoggedTable table(path);
  ImuColumns columns = choice.empty() ? imu_columns(table) : chosen_columns(table, choice);
  unit = chosen(columns.accel_unit, unit, AccelUnit::m_s2, table.header());
  gyro_unit = chosen(columns.gyro_unit, gyro_unit, GyroUnit::rad_s, table.header());
  Imported out;
  if (columns.id) out.notes.push_back(keep_one_imu(table, *columns.id));
  if (columns.stamp_form == StampForm::decimal) {
    const bool stated = columns.stamp_decimals.has_value();
    if (!stated) columns.stamp_decimals = decimals_by_step(table, columns.stamp, path.string());
    say_columns(columns, stated, out.notes);
  }
  LeftOut left_out("readings");
  std::vector<std::string> places;
  sim::ImuRecord imu = readings_of(table, columns, device, unit, gyro_unit, left_out, places);
  const auto where = [&](std::size_t k) { return places[k]; };
  const std::string bursts = leave_out_faulty(where, nullptr, left_out, imu);
  finish_readings(path.string(), unit, imu);
  const std::string evened = even_out_stamps(imu);
  for (const std::string& remark :
       {left_out.note(imu.time_ns.size()), bursts, evened, gaps_text(imu), rates_text(path.string(), imu, gyro_unit)})
    out.notes.push_back(remark);
  std::erase(out.notes, "");
  const std::int64_t first_ns = imu.time_ns.front();
  for (std::int64_t& time : imu.time_ns) time -= first_ns;
  out.info.attribution = fmt::format("imported from {} (first time stamp: {} ns)", path.filename().string(), first_ns);
  out.info.origin_ns = first_ns;
  out.sensors.imus.push_back(std::move(imu));
  return out;
}

}  // namespace tumble::scenarios
