// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/recordings/tables/imu_columns.hpp"

/// logger_columns.hpp identifies the columns in IMU tables of loggers and data sets. Used only within
/// scenarios/recordings.
namespace tumble::scenarios {

/// Finds columns by common names in any order. Case, blanks, points and underscores are ignored. The following column
/// names are known.
/// - One time column: t, time, timestamp, stamp, ts, TimeUS. A temperature T and the seconds since the start
///   (seconds_elapsed) only count as time if there is no other time column.
/// - The rate: gx, gyro_x, gyr_x, wx, omega_x, angular_velocity_x, w_RS_S_x, gyro_rad[0], ...
/// - The specific force: ax, acc_x, accel_x, fx, linear_acceleration_x, a_RS_S_x, accelerometer_m_s2[0], ...
/// - The number of the IMU, if the rows of several IMUs alternate: I, id, instance.
///
/// A unit that a name states is used: "time_ms", "#timestamp [ns]", "gx (deg/s)", "w_RS_S_x [rad s^-1]", "ax [g]".
/// Other columns are ignored and listed in the notes.
///
/// Returns nothing if no column name is known. Throws BadInput with file and line if some columns are missing or an
/// axis is repeated. Throws BadInput also for an unknown unit, for different units of axes, or if the names number
/// several IMUs (gyro1_x, gyro2_x).
std::optional<ImuColumns> logger_columns(const CsvLine& header);

/// Finds the columns that the user names, as in "time=t,gyro=gx,gy,gz,accel=ax,ay,az". A word that is no column name is
/// the column's position, from 0. Two time columns are seconds and nanoseconds. Units in the names are used. Throws
/// BadInput for another text, and for names that are missing or repeated in the table.
ImuColumns chosen_columns(const LoggedTable& table, const std::string& choice);

}  // namespace tumble::scenarios
