// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Public API of the library for most robots. TumblingOdometry is for IMU and lidar of a tumbling body. RollingOdometry
/// is for one to four IMUs of a rolling sphere. Data sheets of sensors are included. Link with tumble::odometry. The
/// underlying methods have separate headers, in one folder per estimated quantity.
#include "tumble/odometry/imu_sheet.hpp"          // IWYU pragma: export
#include "tumble/odometry/lidar_sheet.hpp"        // IWYU pragma: export
#include "tumble/odometry/rolling_odometry.hpp"   // IWYU pragma: export
#include "tumble/odometry/tumbling_odometry.hpp"  // IWYU pragma: export
