// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// The presets are calibration values of the robots in `models/`, for recordings that contain no calibration.
namespace tumble::scenarios::presets {

/// Vector from the rig's centre of mass to the MTi-30, in IMU axes, from `models/rig.xml`.
inline Eigen::Vector3d rig_lever_arm_m() {
  return {-0.022, -0.085, 0.055};
}

/// Bounding box of the rig's own cage, in lidar axes, with a margin of some centimetres. Lidar points inside the
/// bounding box are reflections from the rig.
inline Eigen::AlignedBox3d rig_body_L() {
  return {Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23)};
}

/// SaturationAwareRateEstimator treats gyro readings above kRigSaturationPoint_rad_s as saturated.
/// kRigSaturationPoint_rad_s is slightly below the saturation limit of the gyro in the rig's IMU (MTi-30).
inline constexpr double kRigSaturationPoint_rad_s = 10.45;

inline constexpr double kSphereRadius_m = 0.145;

}  // namespace tumble::scenarios::presets
