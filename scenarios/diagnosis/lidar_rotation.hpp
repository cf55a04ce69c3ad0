// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/diagnosis/lidar_odometry.hpp"
#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// SignedAxes maps the axes of the IMU readings to the true IMU axes: true axis i is `sign[i]` times axis `axis[i]` of
/// the readings.
struct SignedAxes {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  Eigen::Matrix3d matrix() const;
  std::string text() const;
};

/// RotationAgreement describes how well lidar and gyro rotations agree. Each error is the median difference between
/// lidar rotation and gyro rotation over the pairs of sweeps, as a fraction of the median rotation.
struct RotationAgreement {
  std::size_t pairs = 0;
  double unit = 1.0;        ///< 1, 57.3 or 1/57.3
  double unit_error = 1.0;  ///< independent of the lidar mounting
  double delay_s = 0.0;     ///< of the lidar relative to the gyro
  double error_as_read = 1.0;
  SignedAxes axes;
  double axes_error = 1.0;
  double next_error = 1.0;                                     ///< of the second-best axes
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< lidar rotation = `turned` times gyro rotation
  double turned_error = 1.0;
};

/// Returns nothing for fewer than a dozen pairs of sweeps. The result is also empty if no combination of unit, axes and
/// mounting makes gyro and lidar agree within 30 %.
std::optional<RotationAgreement> rotation_agreement(const sim::ImuRecord& imu, const sim::LidarRecord& lidar,
                                                    std::span<const SeenRotation> seen);

/// Returns a note if the rotations of lidar and gyro agree. If the rotations do not agree, returns a warning with a
/// unit, delay, axes or mounting that makes the rotations agree. `imu_minus_lidar_clock_s` is the clock offset that the
/// sweep times already contain. Throws RepairableInput if another value of the option --gyro-unit makes the rotations
/// agree.
std::string agreement_text(const std::string& where, const RotationAgreement& agreement, GyroUnit unit,
                           double imu_minus_lidar_clock_s);

/// Returns the command-line option --T-body-lidar with position [m] and quaternion x y z w. A non-empty text `position`
/// replaces the position of `T_BL`, for example "X Y Z" if the position is unknown.
std::string lidar_pose_option(const Eigen::Isometry3d& T_BL, const std::string& position = "");

struct LidarRotationCheck {
  std::vector<std::string> notes;              ///< at most one for each IMU
  std::optional<RotationAgreement> primary;    ///< for the primary IMU; empty if undetermined
  std::optional<Eigen::Isometry3d> better_BL;  ///< makes lidar and primary IMU agree
};

/// Throws RepairableInput if the header stamps of a bag are wrong, and the record stamps must replace the header
/// stamps.
LidarRotationCheck check_lidar_rotation(const std::string& where, const Imported& recording, GyroUnit unit);

}  // namespace tumble::scenarios
