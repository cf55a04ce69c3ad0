// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Public API of the library for most robots: TumblingOdometry (IMU and lidar of a tumbling body), RollingOdometry (one
/// to four IMUs of a rolling sphere), and data sheets of sensors. Link with tumble::odometry. The underlying methods
/// have separate headers, in one folder per estimated quantity.
#include "tumble/odometry/imu_sheet.hpp"          // IWYU pragma: export
#include "tumble/odometry/lidar_sheet.hpp"        // IWYU pragma: export
#include "tumble/odometry/rolling_odometry.hpp"   // IWYU pragma: export
#include "tumble/odometry/tumbling_odometry.hpp"  // IWYU pragma: export
