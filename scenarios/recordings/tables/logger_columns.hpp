// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/recordings/tables/imu_columns.hpp"

namespace tumble::scenarios {

/// Finds the IMU columns of a table by common names, in any order. Letter case, blanks, points and underscores are
/// ignored.
/// - Time: t, time, timestamp, stamp, ts, TimeUS or SampleTimeFine. A column T (temperature) or seconds_elapsed is the
///   time only if there is no other time column.
/// - Rates: gx, gyro_x, gyr_x, wx, omega_x, angular_velocity_x, w_RS_S_x, gyro_rad[0] and similar.
/// - Specific force: ax, acc_x, accel_x, fx, linear_acceleration_x, a_RS_S_x, accelerometer_m_s2[0] and similar.
/// - Number of the IMU, if the rows of several IMUs alternate: I, id or instance.
///
/// A column name may contain the unit: "time_ms", "#timestamp [ns]", "gx (deg/s)", "w_RS_S_x [rad s^-1]", "ax [g]".
std::optional<ImuColumns> logger_columns(const CsvLine& header);

/// Parses a list of columns such as "time=t,gyro=gx,gy,gz,accel=ax,ay,az". A number instead of a column name is the
/// position of the column, from 0.
ImuColumns chosen_columns(const LoggedTable& table, const std::string& choice);

}  // namespace tumble::scenarios
