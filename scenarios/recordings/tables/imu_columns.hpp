// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/tables/logged_table.hpp"

/// imu_columns.hpp finds the IMU columns of a table.
namespace tumble::scenarios {

/// StampForm is the format of the time stamps in a table.
enum class StampForm {
  split,   ///< whole seconds, and nanoseconds in another column
  decimal  ///< decimal number in some unit
};

struct ImuColumns {
  StampForm stamp_form = StampForm::split;
  std::size_t stamp = 0, stamp_ns = 1;
  std::optional<int> stamp_decimals;  ///< for `decimal`: 9 for seconds, 0 for nanoseconds; empty: unknown unit
  std::array<std::size_t, 3> rate = {8, 9, 10}, force = {12, 13, 14};  ///< default: those of a plain sensor_msgs/Imu
  std::optional<std::size_t> id;                                       ///< column with the number of the IMU
  std::optional<GyroUnit> gyro_unit;                                   ///< units in the column names
  std::optional<AccelUnit> accel_unit;
  std::vector<std::string> left_out;  ///< names of ignored columns
};

/// Finds the IMU columns of a table by their names, or by their positions if the table has no header. There are four
/// groups of names: ROS messages (".../angular_velocity/x", "field.angular_velocity.x"), the command `export` (each
/// once and no other names), its short forms (sec nsec wx.. fx..), and loggers (logger_columns.hpp). Throws BadInput
/// with file and line for unknown, repeated or missing columns.
ImuColumns imu_columns(const LoggedTable& table);

/// Parses the time stamp of a line, in nanoseconds: a number or a date in UTC (number_text.hpp). Throws BadInput with
/// file, line and column if the time stamp is invalid.
std::int64_t stamp_ns(const CsvLine& line, const ImuColumns& columns);

/// Infers the unit of the time stamps from up to a thousand steps at the start of the table, and returns it as a number
/// of decimals. The unit is that of s, ms, us and ns that gives 10 to 1000 samples per second; at most one fits. For
/// other sample rates, the file must contain the unit. If no unit fits, throws BadInput with a message that starts with
/// `file`.
int decimals_by_step(LoggedTable& table, std::size_t stamp, const std::string& file);

}  // namespace tumble::scenarios
