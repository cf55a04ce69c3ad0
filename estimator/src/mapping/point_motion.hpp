// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/detail/sweep_unknowns.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

class PointMotion {
 public:
  PointMotion(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration, const SweepPoint& point,
              std::size_t& hint);

  /// Computes the derivative of the lidar point's position along `direction_W` with respect to the 28 unknowns of the
  /// registration: mapping.md (R17).
  void derivative_along_normal(const Eigen::Vector3d& direction_W, RegistrationUnknowns::Vector& derivative) const;

  /// Returns the lever vector u of the lidar return in world axes, which is the sum of the displacement S and the
  /// vector from the IMU to the lidar return: mapping.md (R3).
  const Eigen::Vector3d& lever_m() const { return lever_arm_; }

 private:
  double t_s_;
  bool clipped_;
  SweepTrajectory::PreintegratedMotion now_;
  Eigen::Vector3d rotated_point_, lever_arm_, point_from_lidar_I_, velocity_m_s_;
  SweepTrajectory::SaturationDeficitJacobian saturation_deficit_jacobian_;  // used if an axis of the gyro is clipped
};

}  // namespace tumble::mapping
