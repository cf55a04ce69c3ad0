// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"

namespace tumble::scenarios {

enum class StampForm {
  split,   ///< seconds and nanoseconds in two columns
  decimal  ///< decimal number in some unit
};

struct ImuColumns {
  StampForm stamp_form = StampForm::split;
  std::size_t stamp = 0, stamp_ns = 1;
  std::optional<int> stamp_decimals;                                   ///< 9: seconds, 0: nanoseconds; empty: unknown
  std::array<std::size_t, 3> rate = {8, 9, 10}, force = {12, 13, 14};  ///< default: a plain sensor_msgs/Imu
  std::optional<std::size_t> id;                                       ///< column with the number of the IMU
  std::optional<GyroUnit> gyro_unit;                                   ///< units in the column names
  std::optional<AccelUnit> accel_unit;
  std::vector<std::string> left_out;  ///< names of ignored columns
};

/// Finds the columns of a table by their names. The known names are those of ROS messages (".../angular_velocity/x"),
/// of the command `export` and of loggers (logger_columns.hpp). Short column names such as sec, nsec, wx and fx are
/// also accepted.
ImuColumns imu_columns(const LoggedTable& table);

std::int64_t stamp_ns(const CsvLine& line, const ImuColumns& columns);

/// Infers the unit of the time stamps from up to a thousand steps at the start of the table. The unit (s, ms, us or ns)
/// is chosen such that the sample rate is 10 to 1000 Hz. Returns the power of ten that converts the unit to
/// nanoseconds: 9 for s, 6 for ms, 3 for us and 0 for ns.
int decimals_by_step(LoggedTable& table, std::size_t stamp, const std::string& file);

}  // namespace tumble::scenarios
