// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

/// A body with an IMU and a lidar that lies still, is thrown through a room while it spins beyond its gyro's rail, is
/// caught and lies still again: all in closed form, made without anything of the library's estimators.
namespace tumble::test {

struct ThrownBody {
  // the throw and the catch take push_s each; in between only gravity acts
  double rest_s = 1.2, push_s = 0.15, flight_s = 0.8, end_s = 3.4;
  double spin_rad_s = 15.0;
  Eigen::Vector3d axis = Eigen::Vector3d(0.25, 0.9, 0.35).normalized();  ///< of the spin, a principal one
  Eigen::Vector3d lever_arm_I_m{-0.03, -0.08, 0.05};                     ///< from the centre of mass to the IMU
  double rail_rad_s = 10.0;                                              ///< of the gyro, each axis
  double imu_hz = 100.0;

  Eigen::Isometry3d T_WI(double t_s) const;
  Eigen::Vector3d w_WI_I_rad_s(double t_s) const;

  /// Means over each window: the exact turn, the exact change of velocity. The gyro clips at its rail.
  std::vector<ImuSample> imu() const;
  struct Sweep {
    TimeNs start_ns = 0, end_ns = 0;
    std::vector<LidarPoint> points;
  };
  /// Of 0.1 s, 16 rings, from the pose at each firing; lidar axes are the IMU's.
  std::vector<Sweep> sweeps() const;

 private:
  double angle_rad(double t_s) const;
  Eigen::Vector3d centre_m(double t_s) const;
  Eigen::Vector3d velocity_m_s(double t_s) const;
};

}  // namespace tumble::test
