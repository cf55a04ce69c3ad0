// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/tables/imu_columns.hpp"
#include "scenarios/recordings/tables/imu_position.hpp"
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

/// Returns the numbers of the IMUs in the order of their first rows; for a single IMU, returns nothing. A column with
/// more than eight different numbers contains row numbers and not IMU numbers.
std::vector<std::string> imus_in(LoggedTable& table, std::size_t id) {
  constexpr std::size_t kImusMax = 8;
  std::vector<std::string> found;
  CsvLine line;
  while (found.size() <= kImusMax && table.next_sound(line)) {
    const std::string number(line.fields[id]);
    if (std::find(found.begin(), found.end(), number) == found.end()) found.push_back(number);
  }
  table.restart();
  if (found.size() < 2 || found.size() > kImusMax) found.clear();
  return found;
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

struct Units {
  AccelUnit accel;
  GyroUnit gyro;
};

/// Reads the samples of one IMU without the faulty samples, and adds remarks for the user to `notes`.
sim::ImuRecord checked_readings(LoggedTable& table, const ImuColumns& columns, const sim::ImuRecord& device,
                                const std::string& path, const Units& units, std::vector<std::string>& notes) {
  LeftOut left_out("readings");
  std::vector<std::string> places;
  sim::ImuRecord imu = readings_of(table, columns, device, units.accel, units.gyro, left_out, places);
  const auto where = [&](std::size_t k) { return places[k]; };
  const std::string bursts = leave_out_faulty(where, nullptr, left_out, imu);
  finish_readings(path, units.accel, imu);
  const std::string evened = even_out_stamps(imu);
  for (const std::string& remark :
       {left_out.note(imu.time_ns.size()), bursts, evened, gaps_text(imu), rates_text(path, imu, units.gyro)})
    notes.push_back(remark);
  std::erase(notes, "");
  return imu;
}

/// Adds IMU number i of the imported table to `out` at its estimated position. An IMU that cannot be read or whose
/// position cannot be estimated is left out. `out.notes` reports the result.
template <class Read>
void add_further_imu(const Read& read, const std::vector<std::string>& imus, std::size_t i, Imported& out) {
  const std::vector<std::string> notes = out.notes;  // the notes on the first IMU hold for all IMUs
  std::string problem;
  try {
    sim::ImuRecord imu = read();
    const sim::ImuRecord& first = out.sensors.imus.front();
    const ImuPosition position = estimate_imu_position(first, imu);
    problem = position.problem;
    out.notes = notes;
    if (problem.empty()) {
      const Eigen::Vector3d& p = position.position_m;
      imu.T_BI.translation() += imu.T_BI.linear() * p;
      out.sensors.imus.push_back(std::move(imu));
      out.notes.push_back(fmt::format(
          "IMU {} is at {} {} {} m from IMU {} with a standard deviation of {} m, estimated from {} samples. "
          "The import assumes the same axes",
          imus[i], rounded(p.x()), rounded(p.y()), rounded(p.z()), imus.front(), rounded(position.sigma_m.maxCoeff()),
          position.samples));
    }
  } catch (const BadInput& error) {
    problem = error.what();
    out.notes = notes;
  }
  if (!problem.empty()) out.notes.push_back(fmt::format("caution: IMU {} is left out: {}", imus[i], problem));
}

}  // namespace

Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device, AccelUnit unit,
                        GyroUnit gyro_unit, const std::string& choice) {
  LoggedTable table(path);
  ImuColumns columns = choice.empty() ? imu_columns(table) : chosen_columns(table, choice);
  unit = chosen(columns.accel_unit, unit, AccelUnit::m_s2, table.header());
  gyro_unit = chosen(columns.gyro_unit, gyro_unit, GyroUnit::rad_s, table.header());
  Imported out;
  const std::vector<std::string> imus = columns.id ? imus_in(table, *columns.id) : std::vector<std::string>();
  if (!imus.empty()) table.keep(*columns.id, imus.front());
  if (columns.stamp_form == StampForm::decimal) {
    const bool stated = columns.stamp_decimals.has_value();
    if (!stated) columns.stamp_decimals = decimals_by_step(table, columns.stamp, path.string());
    say_columns(columns, stated, out.notes);
  }
  const auto read_imu = [&](const sim::ImuRecord& empty) {
    return checked_readings(table, columns, empty, path.string(), {unit, gyro_unit}, out.notes);
  };
  out.sensors.imus.push_back(read_imu(device));
  for (std::size_t i = 1; i < imus.size(); ++i) {
    table.restart();
    table.keep(*columns.id, imus[i]);
    sim::ImuRecord further = device;
    further.name = fmt::format("{}_{}", device.name, imus[i]);
    add_further_imu([&] { return read_imu(further); }, imus, i, out);
  }
  const std::int64_t first_ns = out.sensors.imus.front().time_ns.front();
  std::int64_t earliest_ns = first_ns;
  for (const sim::ImuRecord& imu : out.sensors.imus) earliest_ns = std::min(earliest_ns, imu.time_ns.front());
  for (sim::ImuRecord& imu : out.sensors.imus)
    for (std::int64_t& time : imu.time_ns) time -= earliest_ns;
  out.info.attribution =
      fmt::format("imported from {} (first time stamp: {} ns)", path.filename().string(), earliest_ns);
  out.info.origin_ns = earliest_ns;
  return out;
}

}  // namespace tumble::scenarios
