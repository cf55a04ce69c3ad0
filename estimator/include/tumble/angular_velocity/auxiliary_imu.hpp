// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Another accelerometer on the same rigid body, expressed in the axes and at the time stamps of the primary IMU. What
/// the two read differs by the rotation of the body alone, in flight and in contact.
struct AuxiliaryAccelerometer {
  Eigen::Vector3d p_I_m = Eigen::Vector3d::Zero();   ///< from the primary IMU to it, primary IMU's axes
  std::vector<Eigen::Vector3d> specific_force_m_s2;  ///< one per sample of the primary; NaN where it says nothing
};

/// Another whole IMU C on the same rigid body, as it is mounted and how well it reads. Its biases are not estimated:
/// they are part of the deviations, as are the errors of the mounting.
struct AuxiliaryImu {
  Eigen::Isometry3d T_IC = Eigen::Isometry3d::Identity();  ///< its axes to those of the primary IMU
  double gyro_noise_density = 5.236e-4;                    ///< [rad/s/sqrt(Hz)]; [1e-9, 1]
  double accel_noise_density = 5.9e-4;                     ///< [m/s^2/sqrt(Hz)]; [1e-9, 10]
  double gyro_error_rad_s = 0.01;  ///< bias, and of the scale and the mounting what does not grow; [1e-9, 10]
  double accel_error_m_s2 = 0.07;  ///< difference of the two biases; [1e-9, 10]
  double share_error = 2e-3;       ///< scale and misalignment, as a share of the reading; [0, 1]
  double position_error_m = 2e-3;  ///< of p_IC; [1e-9, 1]
  double clock_error_s = 1e-3;     ///< between the clocks of the two; [0, 0.1]
  ElementRows gyro_elements = {}, accel_elements = {};  ///< of use where one of them clips
};

/// What an auxiliary IMU read at the time of a sample of the primary IMU, its own axes; NaN where an axis says nothing.
/// While an element of it clips, the values are those along its free elements: the axes are off by what is hidden.
struct AuxiliaryReading {
  Eigen::Vector3d rate_rad_s, force_m_s2;
  Eigen::Vector3d rate_sigma_rad_s, force_sigma_m_s2;
  bool rate_by_elements = false, force_by_elements = false;
  /// Nothing.
  AuxiliaryReading();
  bool sees_all_rates() const { return rate_rad_s.allFinite(); }
  /// Bit for bit, NaN being equal to NaN.
  bool same(const AuxiliaryReading& other) const;
};

/// Readings of an auxiliary IMU at the stamps of the primary, by linear interpolation between neighbours no further
/// apart than `gap_max_s`; clipped elements are left out (what does not know: the bound that they are), as `clippings`
/// has them, one per sample (ClippingFinder). Trouble of its samples (check_samples(), but for gaps; `too_few`
/// clippings): nothing is written. No samples: no reading says anything. O(N).
Status align(const AuxiliaryImu& auxiliary_imu, std::span<const ImuSample> samples, std::span<const Clipping> clippings,
             std::span<const ImuSample> primary, double gap_max_s, std::vector<AuxiliaryReading>& out);

}  // namespace tumble
