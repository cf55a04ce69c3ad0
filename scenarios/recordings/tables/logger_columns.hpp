// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/recordings/tables/imu_columns.hpp"

/// The functions in logger_columns.hpp identify the columns in IMU tables of loggers and data sets.
namespace tumble::scenarios {

/// Finds the IMU columns of a table by common names, in any order. Case, blanks, points and underscores are ignored.
/// The function accepts the following column names.
/// - The time column has the name t, time, timestamp, stamp, ts, TimeUS or SampleTimeFine. A column T (temperature) or
///   seconds_elapsed counts as time only if there is no other time column.
/// - The rate columns have names such as gx, gyro_x, gyr_x, wx, omega_x, angular_velocity_x, w_RS_S_x, gyro_rad[0].
/// - The specific force columns have names such as ax, acc_x, accel_x, fx, linear_acceleration_x, a_RS_S_x,
///   accelerometer_m_s2[0].
/// - The column I, id or instance contains the number of the IMU, if the rows of several IMUs alternate.
///
/// A unit in a column name is used: "time_ms", "#timestamp [ns]", "gx (deg/s)", "w_RS_S_x [rad s^-1]", "ax [g]". The
/// function ignores other columns and lists them in the notes.
///
/// Returns nothing if the table has none of these column names. Throws BadInput with file and line if some columns are
/// missing or an axis is repeated. Throws BadInput for an unknown unit, for axes with different units, or for names
/// with several IMU numbers (gyro1_x, gyro2_x).
std::optional<ImuColumns> logger_columns(const CsvLine& header);

/// Finds the columns that the user lists, for example in "time=t,gyro=gx,gy,gz,accel=ax,ay,az". A word in the list that
/// is no column name is the position of the column, from 0. If there are two time columns, they contain seconds and
/// nanoseconds. Units in the column names are used. Throws BadInput for an invalid list, and for names that are missing
/// or repeated in the table.
ImuColumns chosen_columns(const LoggedTable& table, const std::string& choice);

}  // namespace tumble::scenarios
