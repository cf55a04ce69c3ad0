// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// Bounds of StationaryBounds: at rest, the angular rate differs from the gyro bias by at most `kRate_rad_s`, and the
/// specific force differs from gravity by at most `kForce_m_s2`.
RestDetector::Params mapping_stationary_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
