// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/status.hpp"

namespace tumble {

/// RigConstants contains the calibration constants that are estimated together with the rates of a run: 20 numbers, in
/// the order of the members.
struct RigConstants {
  static constexpr int kSize = 20, kElements = 14;
  static constexpr double kMagnitudeMax = 10.0;  ///< maximum magnitude of each number, in its unit
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();      ///< vector t from the centre of mass to the IMU, IMU axes
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();  ///< bias: reading minus true value
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();  ///< bias: reading minus true value
  /// Shape of the inertia about the centre of mass in IMU axes, without scale: J = 1 + sum_i inertia_i S_i. The
  /// matrices S_i are an orthonormal basis of the traceless symmetric matrices. Zero means that all principal moments
  /// of inertia are equal.
  Eigen::Matrix<double, 5, 1> inertia = Eigen::Matrix<double, 5, 1>::Zero();
  /// Directions of the gyro's sensing elements before the device's compensation. Sensing element j measures the
  /// component of the rate along the row m_j. The row m_j is 1 on axis j, elements[2j] on axis (j+1) % 3 and
  /// elements[2j+1] on axis (j+2) % 3. The sensing directions are observable only while a sensing element clips.
  Eigen::Matrix<double, 6, 1> elements = Eigen::Matrix<double, 6, 1>::Zero();

  /// Returns the row m_j, the sensing direction of sensing element j.
  Eigen::Vector3d sensing_direction(int j) const;
  /// Returns the normalised inertia J, with trace 3.
  Eigen::Matrix3d inertia_matrix() const;
  /// Returns the coordinates `inertia` of a symmetric matrix of any positive scale.
  static Eigen::Matrix<double, 5, 1> inertia_coordinates(const Eigen::Matrix3d& inertia);
  /// Returns the basis matrix S_i, i in 0..4.
  static const Eigen::Matrix3d& inertia_basis(int i);

  Vector vector() const;
  void add(const Vector& step);
  bool operator==(const RigConstants&) const = default;
};

/// RigCalibration is the calibration that one run estimated, which can initialise another run.
struct RigCalibration {
  RigConstants constants;
  RigConstants::Matrix covariance = RigConstants::Matrix::Identity();
};

/// Returns `out_of_range` if a constant exceeds the limits of any plausible rig.
Status check_rig_constants(const RigConstants& rig);
/// Checks a calibration like check_rig_constants(), and also checks the covariance. Returns `degenerate` if the
/// covariance is not positive definite, because a run cannot start from a singular covariance.
Status check_calibration(const RigCalibration& calibration);

}  // namespace tumble
