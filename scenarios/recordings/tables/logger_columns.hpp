// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/recordings/tables/imu_columns.hpp"

/// Tables of IMUs as loggers and data sets write them. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Columns by the names that loggers give, in any order, capitals, blanks, points and underscores of no account: one
/// time (t, time, timestamp, stamp, ts), the rate (gx, gyro_x, gyr_x, wx, omega_x, angular_velocity_x, w_RS_S_x, ...)
/// and the specific force (ax, acc_x, accel_x, fx, linear_acceleration_x, a_RS_S_x, ...). A unit behind a name is
/// believed: "time_ms", "#timestamp [ns]", "gx (deg/s)", "w_RS_S_x [rad s^-1]", "ax [g]". Others are left out and
/// named. None where no name is known; throws BadInput with file and line where some are and others are missing, where
/// two are of the same axis, a unit is unknown, or axes are in several.
std::optional<ImuColumns> logger_columns(const CsvLine& header);

}  // namespace tumble::scenarios
