// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Includes the classes that most robots need, and the data sheets of common sensors. Link with tumble::odometry.
/// TumblingOdometry processes the IMU and lidar of a tumbling body. RollingOdometry processes one to four IMUs of a
/// rolling sphere. Every other estimator has a separate header, in one folder per estimated quantity.
#include "tumble/odometry/rolling_odometry.hpp"   // IWYU pragma: export
#include "tumble/odometry/sensor_sheets.hpp"      // IWYU pragma: export
#include "tumble/odometry/tumbling_odometry.hpp"  // IWYU pragma: export
