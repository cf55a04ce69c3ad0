// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// The presets are numbers of the robots in `models/` without a default in the library. Values in a recording have
/// priority.
namespace tumble::scenarios::presets {

/// Returns the vector from the rig's centre of mass to the MTi-30, in IMU axes, from `models/rig.xml`.
Eigen::Vector3d rig_lever_arm_m();

/// The box around the rig's cage, in lidar axes, has a margin of some centimetres. Lidar points inside the box are
/// reflections from the rig.
Eigen::AlignedBox3d rig_body_L();

/// Saave's method treats gyro readings above this point as saturated. The point is slightly below the saturation limit
/// of the gyro in `models/sensors/mti30.yaml`.
inline constexpr double kRigSaturationPoint_rad_s = 10.45;

inline constexpr double kSphereRadius_m = 0.145;

}  // namespace tumble::scenarios::presets
