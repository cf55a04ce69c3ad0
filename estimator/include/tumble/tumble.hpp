// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The door of the library, all that most robots need: TumblingOdometry (IMU samples and lidar sweeps of a body that
/// tumbles), RollingOdometry (one or several IMUs of a sphere that rolls), and sheets of sensors. Link with
/// tumble::odometry. The methods that they are made of have headers of their own beside this one, by what they
/// estimate.
#include "tumble/odometry/imu_sheet.hpp"          // IWYU pragma: export
#include "tumble/odometry/lidar_sheet.hpp"        // IWYU pragma: export
#include "tumble/odometry/rolling_odometry.hpp"   // IWYU pragma: export
#include "tumble/odometry/tumbling_odometry.hpp"  // IWYU pragma: export
