// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Calibration between lidar, IMU and world, which the registration refines during the motion. The error vector
/// contains rotation of T_IL, translation of T_IL, time offset and gravity, in this order. The rotation error phi is a
/// left perturbation in IMU axes: R_true = Exp(phi) R.
struct LidarImuCalibration {
  static constexpr int kErrorCount = 10;
  using Covariance = Eigen::Matrix<double, kErrorCount, kErrorCount>;

  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  double time_offset_s = 0.0;                              ///< IMU clock minus lidar clock
  Eigen::Vector3d gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.80665);

  void add(const Eigen::Matrix<double, kErrorCount, 1>& error);
  /// Returns the error vector that transforms `other` to this calibration, to first order in the rotation difference.
  Eigen::Matrix<double, kErrorCount, 1> minus(const LidarImuCalibration& other) const;
};

/// `deviations` is the result of LidarImuCalibrationPrior::distance_in_sigmas(). Returns `out_of_range` above
/// kDistanceMax_sigmas.
Status distance_verdict(double deviations);

/// Calibration that the caller states, with a standard deviation of the time offset, and standard deviations of
/// rotation and translation per axis.
/// A standard deviation of 0 marks an exact part of the calibration.
struct LidarImuCalibrationPrior {
  static constexpr double kDistanceMax_sigmas = 5.0;  ///< largest plausible result of distance_in_sigmas()

  LidarImuCalibration calibration;
  double mount_sigma_rad = 0.0, mount_sigma_m = 0.0, time_offset_sigma_s = 0.0;

  /// Returns how many stated standard deviations an estimated calibration is from the stated calibration, by equation
  /// (R69) of mapping.md. The result is the largest of the distances of rotation, translation and time offset. The
  /// result is infinite if a value with standard deviation 0 differs.
  double distance_in_sigmas(const LidarImuCalibration& estimated) const;
  /// Returns `out_of_range` if distance_in_sigmas() is above kDistanceMax_sigmas, because the stated calibration is
  /// probably wrong.
  Status verdict(const LidarImuCalibration& estimated) const;
};

}  // namespace tumble

/// Describes the parameters that state the accuracy of the lidar's mounting and time offset.
namespace tumble::calibration_fields {

inline constexpr Field kMountSigma_rad{
    "mount_sigma_rad",
    "rad",
    0.0,
    1.0,
    "prior standard deviation of the lidar's orientation relative to the IMU; 0: exact, no estimate",
    ParameterRank::common_use};
inline constexpr Field kMountSigma_m{
    "mount_sigma_m",
    "m",
    0.0,
    1.0,
    "prior standard deviation of the lidar's position relative to the IMU; 0: exact, no estimate",
    ParameterRank::common_use};
inline constexpr Field kTimeOffsetSigma_s{
    "time_offset_sigma_s",
    "s",
    0.0,
    0.02,
    "prior standard deviation of the time offset between lidar and IMU; 0: no offset, no estimate",
    ParameterRank::common_use};

}  // namespace tumble::calibration_fields
