// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/recordings/tables/imu_columns.hpp"

/// IMU tables of loggers and data sets. Used only within scenarios/recordings.
namespace tumble::scenarios {

/// Finds columns by common names in any order, ignoring case, blanks, points and underscores:
/// - a single time column: t, time, timestamp, stamp, ts;
/// - the rate: gx, gyro_x, gyr_x, wx, omega_x, angular_velocity_x, w_RS_S_x, ...;
/// - the specific force: ax, acc_x, accel_x, fx, linear_acceleration_x, a_RS_S_x, ...
///
/// A unit that a name states is used: "time_ms", "#timestamp [ns]", "gx (deg/s)", "w_RS_S_x [rad s^-1]", "ax [g]".
/// Other columns are ignored and listed.
///
/// Returns empty if no name is known. Throws BadInput with file and line if some columns are missing, an axis is
/// repeated, a unit is unknown, or axes have different units.
std::optional<ImuColumns> logger_columns(const CsvLine& header);

}  // namespace tumble::scenarios
