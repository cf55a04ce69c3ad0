// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// At rest, the angular rate is within `kRate_rad_s` of the gyro bias, and the specific force is within `kForce_m_s2`
/// of gravity (StationaryBounds).
RestDetector::Params mapping_stationary_params(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
