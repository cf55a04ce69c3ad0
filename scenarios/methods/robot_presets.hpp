// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// robot_presets.hpp defines parameters without a default in the library: numbers of the robots in `models/`. Values in
/// a recording have priority.
namespace tumble::scenarios::presets {

/// Returns the vector from the rig's centre of mass to the MTi-30, in IMU axes, from `models/rig.xml`.
Eigen::Vector3d rig_lever_arm_m();

/// Returns a box around the rig's cage in lidar axes, with a margin of some centimetres. Lidar points inside the box
/// are reflections from the rig.
Eigen::AlignedBox3d rig_body_L();

/// kRigSaturationPoint_rad_s is slightly below the saturation limit of the gyro in `models/sensors/mti30.yaml`. Saave's
/// method treats larger gyro readings as saturated.
inline constexpr double kRigSaturationPoint_rad_s = 10.45;

/// kSphereRadius_m is the radius of the sphere's shell, from `models/sphere.xml`.
inline constexpr double kSphereRadius_m = 0.145;

}  // namespace tumble::scenarios::presets
