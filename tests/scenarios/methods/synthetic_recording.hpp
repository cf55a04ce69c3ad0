// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "sim/recording.hpp"

namespace tumble::scenarios::testing {

/// A closed-form recording without the simulator. The body rests, then rotates about one fixed axis by `angle_rad`
/// while its centre of mass moves by `displacement_m`, both along the same smooth step (quintic), then rests again.
/// Readings are exact at the middle of their window, without noise; the gyro is clipped at `rail_rad_s`.
struct SyntheticMotion {
  Eigen::Vector3d axis_W = Eigen::Vector3d(0.3, 0.9, -0.2).normalized();
  double angle_rad = 22.4;  ///< peak rate 1.875 angle / (end - start) = 14 rad/s
  Eigen::Vector3d displacement_m = {1.5, -0.8, 0.4};
  Eigen::Vector3d start_m = {-0.5, 0.5, 1.0};
  Eigen::Quaterniond q_start = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  double start_s = 1.5;
  double end_s = 4.5;
  double duration_s = 6.0;
  double rail_rad_s = 10.5;

  Eigen::Vector3d position_m(double time_s) const;
  Eigen::Quaterniond attitude(double time_s) const;
  Eigen::Vector3d velocity_m_s(double time_s) const;
  Eigen::Vector3d rate_B_rad_s(double time_s) const;
  /// Returns the specific force at a point of the body, in body axes.
  Eigen::Vector3d specific_force_B_m_s2(double time_s, const Eigen::Vector3d& p_B_m) const;

 private:
  double phase(double time_s) const;
  double phase_rate(double time_s) const;
  double phase_acceleration(double time_s) const;
};

/// Half width and height of the open room, whose floor and walls the synthetic lidar sees.
inline constexpr double kRoomHalfM = 5.0;
inline constexpr double kRoomHeightM = 2.5;

/// A rig with one IMU (200 Hz) and a lidar (10 Hz, 16 rings, 150 columns), which rotates above the floor of the room.
sim::Recording synthetic_rig(const SyntheticMotion& motion = {});

/// A sphere that rolls along `direction_rad` by `distance_m` without slip, with one IMU off its centre and a lidar
/// inside.
sim::Recording synthetic_sphere(double distance_m = 1.0, double direction_rad = 0.6);

}  // namespace tumble::scenarios::testing
