// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Mounting and accuracy of an additional IMU C on the body of the primary IMU. Biases and mounting errors of an
/// additional IMU are not estimated. They increase the standard deviations of its readings.
struct AuxiliaryImu {
  Eigen::Isometry3d T_imu_device = Eigen::Isometry3d::Identity();  ///< pose of C in the axes of the primary IMU
  double gyro_noise_density = 5.236e-4;                            ///< [rad/s/sqrt(Hz)]; allowed: [1e-9, 1]
  double accel_noise_density = 5.9e-4;                             ///< [m/s^2/sqrt(Hz)]; allowed: [1e-9, 10]
  double gyro_error_rad_s = 0.01;  ///< standard deviation of bias and other rate-independent errors; [1e-9, 10]
  double accel_error_m_s2 = 0.07;  ///< standard deviation of the bias relative to the primary IMU; [1e-9, 10]
  double scale_error = 2e-3;       ///< relative scale and misalignment error; allowed: [0, 1]
  double position_error_m = 2e-3;  ///< standard deviation of the position p_IC; allowed: [1e-9, 1]
  double clock_error_s = 1e-3;     ///< standard deviation of the time offset to the primary IMU; allowed: [0, 0.1]
  SensingDirections gyro_sensing_directions = {},
                    accel_sensing_directions = {};  ///< needed if an accelerometer element clips
};

/// Reading of an additional IMU, interpolated at the time of a sample of the primary IMU. Rate and force are in the
/// axes of the additional IMU; NaN marks an axis without a valid reading. While a sensing element clips, the vectors
/// contain the components along the three sensing elements instead.
struct AuxiliaryReading {
  Eigen::Vector3d rate_rad_s, force_m_s2;
  Eigen::Vector3d rate_sigma_rad_s, force_sigma_m_s2;
  bool rate_along_sensing_axes = false, force_along_sensing_axes = false;
  AuxiliaryReading();
  bool measures_all_rates() const { return rate_rad_s.allFinite(); }
};

/// Interpolates the unclipped readings of an additional IMU at the time stamps of the primary IMU, linearly between
/// readings at most `gap_max_s` apart. `clippings` contains one result of ClippingFinder per sample. Returns `ok`, an
/// error of check_samples() other than `gap`, or `insufficient_data` if `clippings` has fewer entries than `samples`.
/// On error, `out` is unchanged. Cost: O(N).
Status align(const AuxiliaryImu& auxiliary_imu, std::span<const ImuSample> samples, std::span<const Clipping> clippings,
             std::span<const ImuSample> primary, double gap_max_s, std::vector<AuxiliaryReading>& out);

}  // namespace tumble
