// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// Default parameters for which the library has no default: numbers of the robots in `models/`. A recording states its
/// own.
namespace tumble::scenarios::presets {

/// Returns the vector from the rig's centre of mass to its MTi-30, IMU axes; `models/rig.xml`.
Eigen::Vector3d rig_lever_arm_m();

/// Returns a box around the rig's cage in lidar axes, with a margin of some centimetres; returns inside it hit the rig
/// itself.
Eigen::AlignedBox3d rig_body_L();

/// Slightly below the gyro's saturation level in `models/sensors/mti30.yaml`; the method of Saave tests for larger
/// readings.
inline constexpr double kRigSaturationPoint_rad_s = 10.45;

/// Radius of the sphere's shell; `models/sphere.xml`.
inline constexpr double kSphereRadius_m = 0.145;

}  // namespace tumble::scenarios::presets
