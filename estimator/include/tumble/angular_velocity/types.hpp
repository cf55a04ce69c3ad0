// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

enum class AngularRateSource : std::uint8_t {
  measured,              ///< no gyro axis is clipped or possibly clipped
  recovered_in_flight,   ///< clipped; recovered from the centripetal force in free flight
  recovered_in_contact,  ///< clipped; recovered from the specific force during contact
  lower_bound_only,      ///< clipped or possibly clipped; limited only by a lower bound and by smooth motion
};

const char* to_string(AngularRateSource source);

/// Angular velocity of an IMU relative to the world, in IMU axes, at the time of an IMU sample.
struct AngularRateState {
  TimeNs time_ns = 0;
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
  std::uint8_t clipped_axes = 0;  ///< bit j: gyro axis j was saturated
  AngularRateSource source = AngularRateSource::measured;
};

/// Contains the 20 constants of body and IMU that AngularRateSmoother and AngularRateStream estimate together with the
/// angular velocity.
struct BodyImuConstants {
  static constexpr int kSize = 20, kGyroMisalignmentIndex = 14;
  static constexpr double kMaxConstantMagnitude = 10.0;  ///< maximum magnitude of each constant, in its unit
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< vector from the centre of mass to the IMU, in IMU axes
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();  ///< bias: reading minus true value
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();  ///< bias: reading minus true value
  /// Coordinates of the body's inertia matrix about the centre of mass, in IMU axes. The inertia matrix is scaled to
  /// trace 3, and is the identity matrix plus the sum of inertia_coordinates[i] * inertia_basis_matrix(i). If the
  /// principal moments are equal, all five coordinates are zero.
  Eigen::Matrix<double, 5, 1> inertia_coordinates = Eigen::Matrix<double, 5, 1>::Zero();
  /// Cross-axis sensitivities of the gyro's sensing elements, before the device's compensation. The sensing direction
  /// of element j has the components 1 on axis j, gyro_misalignment[2j] on axis (j+1) % 3 and gyro_misalignment[2j+1]
  /// on axis (j+2) % 3. The cross-axis sensitivities are observable only while a sensing element clips.
  Eigen::Matrix<double, 6, 1> gyro_misalignment = Eigen::Matrix<double, 6, 1>::Zero();

  /// Returns the direction in IMU axes along which the gyro's sensing element 0, 1 or 2 measures.
  Eigen::Vector3d gyro_sensing_direction(int element) const;
  /// Returns the inertia matrix about the centre of mass in IMU axes, scaled to trace 3.
  Eigen::Matrix3d inertia_matrix_with_trace_3() const;
  /// Returns the five `inertia_coordinates` of the symmetric matrix `inertia`. Scaling `inertia` by a positive factor
  /// does not change the result.
  static Eigen::Matrix<double, 5, 1> inertia_basis_coordinates(const Eigen::Matrix3d& inertia);
  static const Eigen::Matrix3d& inertia_basis_matrix(int i);

  Vector vector() const;
  void add(const Vector& increment);
  bool operator==(const BodyImuConstants&) const = default;
};

/// Constants of body and IMU that one run estimated, with their covariance, as prior for a later run.
struct BodyImuCalibration {
  BodyImuConstants constants;
  BodyImuConstants::Matrix covariance = BodyImuConstants::Matrix::Identity();
};

/// Returns `out_of_range` if the magnitude of a constant of body or IMU exceeds
/// BodyImuConstants::kMaxConstantMagnitude.
Status check_body_imu_constants(const BodyImuConstants& constants);
/// Returns `ok`, an error of check_body_imu_constants(), or `degenerate` if the covariance is not positive definite.
Status check_body_imu_calibration(const BodyImuCalibration& calibration);

}  // namespace tumble
