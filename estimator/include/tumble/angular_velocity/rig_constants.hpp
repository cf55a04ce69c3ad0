// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/status.hpp"

namespace tumble {

/// RigConstants contains the 20 constants of a rig that RateSmoother and RateStream estimate together with the rates.
struct RigConstants {
  static constexpr int kSize = 20, kElements = 14;
  static constexpr double kMagnitudeMax = 10.0;  ///< maximum magnitude of each constant, in its unit
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< vector from the centre of mass to the IMU, in IMU axes
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();  ///< bias: reading minus true value
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();  ///< bias: reading minus true value
  /// Ratios of the inertia about the centre of mass in IMU axes, without scale: J = 1 + sum_i inertia_i S_i. The
  /// matrices S_i are an orthonormal basis of the traceless symmetric matrices. The default zero means that all
  /// principal moments of inertia are equal.
  Eigen::Matrix<double, 5, 1> inertia = Eigen::Matrix<double, 5, 1>::Zero();
  /// Cross-axis sensitivities of the gyro's sensing elements, before the device's compensation. Sensing element j
  /// measures the component of the rate along the row m_j. The row m_j is 1 on axis j, elements[2j] on axis (j+1) % 3
  /// and elements[2j+1] on axis (j+2) % 3. The cross-axis sensitivities are observable only while a sensing element
  /// clips.
  Eigen::Matrix<double, 6, 1> elements = Eigen::Matrix<double, 6, 1>::Zero();

  Eigen::Vector3d sensing_direction(int j) const;
  /// The inertia matrix is normalised to trace 3.
  Eigen::Matrix3d inertia_matrix() const;
  /// Returns the coordinates `inertia` of a symmetric inertia matrix of any positive scale.
  static Eigen::Matrix<double, 5, 1> inertia_coordinates(const Eigen::Matrix3d& inertia);
  static const Eigen::Matrix3d& inertia_basis(int i);

  Vector vector() const;
  void add(const Vector& step);
  bool operator==(const RigConstants&) const = default;
};

/// RigCalibration contains the rig constants that one run estimated, with their covariance. A later run can use the
/// calibration as prior.
struct RigCalibration {
  RigConstants constants;
  RigConstants::Matrix covariance = RigConstants::Matrix::Identity();
};

/// Returns `out_of_range` if a rig constant exceeds its plausible maximum, and otherwise `ok`.
Status check_rig_constants(const RigConstants& rig);
/// Checks that rig constants are plausible and that their covariance is positive definite. Returns `out_of_range` for
/// an implausible constant and `degenerate` for an invalid covariance.
Status check_calibration(const RigCalibration& calibration);

}  // namespace tumble
