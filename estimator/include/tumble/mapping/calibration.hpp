// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tumble/common/status.hpp"

namespace tumble {

/// Calibration between lidar, IMU and world. The initial values come from an external calibration and are refined
/// during the motion. Errors are ordered (rotation of T_IL, left perturbation in IMU axes: R_true = Exp(phi) R;
/// translation of T_IL; time offset; gravity).
struct SweepCalibration {
  static constexpr int kErrors = 10;
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;

  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< lidar in IMU axes
  double time_offset_s = 0.0;                              ///< the IMU's clock minus the lidar's
  Eigen::Vector3d gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.80665);

  /// Adds a small error in the order above.
  void add(const Eigen::Matrix<double, kErrors, 1>& error);
  /// Returns the error that transforms `other` to this, to first order in the difference of rotation.
  Eigen::Matrix<double, kErrors, 1> minus(const SweepCalibration& other) const;
};

/// A stated calibration with the standard deviation of each part per axis; 0 for an exact part.
struct GivenCalibration {
  static constexpr double kBelieved = 5.0;  ///< plausible change during one run, in standard deviations

  SweepCalibration calibration;
  double mount_sigma_rad = 0.0, mount_sigma_m = 0.0, time_offset_sigma_s = 0.0;

  /// Returns the distance of `learnt` from the stated calibration in standard deviations: the largest of rotation,
  /// translation and time offset. The distance is infinite if an exact part differs. mapping.md (R69). Gravity is
  /// excluded because each run estimates it.
  double moved(const SweepCalibration& learnt) const;
  /// Returns `out_of_range` if `learnt` is more than `kBelieved` standard deviations away. The stated calibration is
  /// then wrong.
  Status verdict(const SweepCalibration& learnt) const;
};

}  // namespace tumble
