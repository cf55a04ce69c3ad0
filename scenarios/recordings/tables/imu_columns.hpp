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
#include "scenarios/recordings/tables/csv_text.hpp"

/// Which columns of a table are the readings of an IMU. Private to scenarios/recordings.
namespace tumble::scenarios {

/// How a line says when it was.
enum class StampForm {
  split,    ///< whole seconds, and nanoseconds in a column of their own
  seconds,  ///< "1617333602.223639727", nine decimals at most
  decimal   ///< a number of some unit, with any decimals
};

struct ImuColumns {
  StampForm stamp_form = StampForm::split;
  std::size_t stamp = 0, stamp_ns = 1;
  std::optional<int> stamp_decimals;  ///< of `decimal`: 9 where it is in seconds, 0 in nanoseconds; none: not stated
  std::array<std::size_t, 3> rate = {8, 9, 10}, force = {12, 13, 14};  ///< as a plain sensor_msgs/Imu has them
  std::optional<GyroUnit> gyro_unit;                                   ///< as the names state it
  std::optional<AccelUnit> accel_unit;
  bool has_header = true;
  std::vector<std::string> left_out;  ///< names of a logger's other columns
};

/// Of the first line. Names are believed before places: those of tools that flatten ROS messages
/// (".../angular_velocity/x"), those of `export`, each once and no other, short forms of them (sec nsec wx.. fx..), or
/// those of loggers (logger_columns.hpp). A line of numbers is a sample, whose columns stand by place. Throws BadInput
/// with file and line: unknown, doubled or missing columns.
ImuColumns imu_columns(const CsvLine& first);

/// Nanoseconds of a line's stamp. Throws BadInput with file, line and column.
std::int64_t stamp_ns(const CsvLine& line, const ImuColumns& columns);

/// Throws BadInput, the line's place before it, where a line has not as many columns as the first.
void require_width(const CsvLine& line, std::size_t columns);

/// Decimals of the unit of stamps that state none, of their first thousand steps: the one of s, ms, us and ns for which
/// the IMU reads 10 to 1000 times a second, which at most one is: a slower or a faster one must say its unit. `text`
/// stands before the first sample, whose lines must be of `columns`. Throws BadInput beginning with the file where none
/// is.
int decimals_by_step(CsvText text, std::size_t stamp, std::size_t columns, const std::string& file);

}  // namespace tumble::scenarios
