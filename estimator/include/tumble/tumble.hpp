// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Includes the parts of the library that most robots need, and the data sheets of sensors. Link with tumble::odometry.
/// TumblingOdometry processes the IMU and lidar of a tumbling body. RollingOdometry processes one to four IMUs of a
/// rolling sphere.
#include "tumble/odometry/detail/saved_map.hpp"   // IWYU pragma: export
#include "tumble/odometry/imu_sheet.hpp"          // IWYU pragma: export
#include "tumble/odometry/lidar_sheet.hpp"        // IWYU pragma: export
#include "tumble/odometry/rolling_odometry.hpp"   // IWYU pragma: export
#include "tumble/odometry/tumbling_odometry.hpp"  // IWYU pragma: export
