// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tumble/common/status.hpp"

namespace tumble {

/// What ties a lidar to an IMU and both to the world, known to a calibration's accuracy only and refined with the
/// motion. Errors are ordered (rotation of T_IL, left perturbation in IMU axes: R_true = Exp(phi) R; translation of
/// T_IL; time offset; gravity).
struct SweepCalibration {
  static constexpr int kErrors = 10;
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;

  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< lidar in IMU axes
  double time_offset_s = 0.0;                              ///< the IMU's clock minus the lidar's
  Eigen::Vector3d gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.80665);

  /// Adds a small error in the order above.
  void add(const Eigen::Matrix<double, kErrors, 1>& error);
  /// The error that takes `other` to this, first order in the rotation's difference.
  Eigen::Matrix<double, kErrors, 1> minus(const SweepCalibration& other) const;
};

/// A calibration as it was given, with the deviation of each axis of its parts; 0 for a part that is exact.
struct GivenCalibration {
  static constexpr double kBelieved = 5.0;  ///< deviations that a calibration may move by in one run

  SweepCalibration calibration;
  double mount_sigma_rad = 0.0, mount_sigma_m = 0.0, time_offset_sigma_s = 0.0;

  /// How far `learnt` is from it, in its deviations: the largest of rotation, translation and time offset; infinite
  /// where a part that is exact differs. mapping.md (R55). Gravity, which each run finds by itself, does not count.
  double moved(const SweepCalibration& learnt) const;
  /// `out_of_range` where `learnt` lies more than `kBelieved` deviations away: it was given wrong.
  Status verdict(const SweepCalibration& learnt) const;
};

}  // namespace tumble
