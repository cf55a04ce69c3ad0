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

/// The header imu_columns.hpp finds the IMU columns of a table.
namespace tumble::scenarios {

/// StampForm is the format of the time stamps in a table.
enum class StampForm {
  split,   ///< whole seconds, and nanoseconds in another column
  decimal  ///< a decimal number in some unit
};

struct ImuColumns {
  StampForm stamp_form = StampForm::split;
  std::size_t stamp = 0, stamp_ns = 1;
  std::optional<int> stamp_decimals;  ///< for `decimal`: 9 for seconds, 0 for nanoseconds; empty: unit not stated
  std::array<std::size_t, 3> rate = {8, 9, 10}, force = {12, 13, 14};  ///< default: a plain sensor_msgs/Imu
  std::optional<std::size_t> id;                                       ///< column with the number of the IMU
  std::optional<GyroUnit> gyro_unit;                                   ///< unit stated by the names
  std::optional<AccelUnit> accel_unit;
  std::vector<std::string> left_out;  ///< names of ignored columns
};

/// Finds the IMU columns of a table by their names, or by their positions. Column names take precedence over positions.
/// Four groups of names are accepted: ROS messages (".../angular_velocity/x", "field.angular_velocity.x"), the command
/// `export` (each once and no other names), its short forms (sec nsec wx.. fx..), and loggers (logger_columns.hpp). In
/// a table without a header, the positions identify the columns. Throws BadInput with file and line for unknown,
/// repeated or missing columns.
ImuColumns imu_columns(const LoggedTable& table);

/// Parses the time stamp of a line, in nanoseconds: a number or a date in UTC (number_text.hpp). Throws BadInput with
/// file, line and column if the time stamp is invalid.
std::int64_t stamp_ns(const CsvLine& line, const ImuColumns& columns);

/// Infers the unit of the time stamps from up to a thousand time steps, and returns it as a number of decimals. The
/// unit is the one of s, ms, us and ns that gives 10 to 1000 samples per second. At most one unit fits the time stamps
/// of a table. For other sample rates, the file must contain the unit. The function reads samples from the start of the
/// table. The error message starts with `file`. Throws BadInput if no unit fits the time steps.
int decimals_by_step(LoggedTable& table, std::size_t stamp, const std::string& file);

}  // namespace tumble::scenarios
