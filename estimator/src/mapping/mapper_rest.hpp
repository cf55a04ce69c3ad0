// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::mapping {

/// Returns the parameters of the mapper's rest detector. At rest, the mean rate is within `rest.rate_rad_s` of the gyro
/// bias on each axis, and gyro readings are within 1/sqrt(3) of `rest.rate_rad_s` of their mean. The specific force is
/// within `rest.force_m_s2` of gravity and of its mean. The limits of rest detection are heuristic.
RestDetector::Params mapper_rest(const LidarInertialOdometry::Params& params);

}  // namespace tumble::mapping
