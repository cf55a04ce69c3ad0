// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// What methods show as defaults where the library has none: numbers of the robots of `models/`, which a recording
/// states of its own robot.
namespace tumble::scenarios::presets {

/// From the rig's centre of mass to its MTi-30, IMU axes; `models/rig.xml`.
Eigen::Vector3d rig_lever_arm_m();

/// Holds the rig's cage as its lidar sees it, lidar axes, some centimetres wider: returns within are its own.
Eigen::AlignedBox3d rig_body_L();

/// Slightly below the plateau at which the gyro of `models/sensors/mti30.yaml` stays: Saave asks for readings beyond.
inline constexpr double kRigSaturationPoint_rad_s = 10.45;

/// Of the sphere's shell; `models/sphere.xml`.
inline constexpr double kSphereRadius_m = 0.145;

}  // namespace tumble::scenarios::presets
