// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// The presets are calibration values of the robots in `models/`, for recordings that contain no calibration.
namespace tumble::scenarios::presets {

/// Vector from the rig's centre of mass to the MTi-30, in IMU axes, from `models/rig.xml`.
Eigen::Vector3d rig_lever_arm_m();

/// Bounding box of the rig's own cage, in lidar axes, with a margin of some centimetres. Lidar points inside the
/// bounding box are reflections from the rig.
Eigen::AlignedBox3d rig_body_L();

/// SaturationAwareRateEstimator's method treats gyro readings above this rate as saturated; the rate is slightly below
/// the saturation limit of the MTi-30.
inline constexpr double kRigSaturationPoint_rad_s = 10.45;

inline constexpr double kSphereRadius_m = 0.145;

}  // namespace tumble::scenarios::presets
