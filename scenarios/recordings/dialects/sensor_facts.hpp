// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/point_store.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// What a peer's configuration asks of the first IMU.
struct ImuFacts {
  std::string device;
  std::size_t samples = 0;
  double period_s = 0.0;
  double gyro_noise_rad_s_sqrt_hz = 0.0, accel_noise_m_s2_sqrt_hz = 0.0;  ///< of the data sheet; 0: not stated
  double stated_gyro_range_rad_s = 0.0, stated_accel_range_m_s2 = 0.0;    ///< of the data sheet; 0: not stated
  double largest_gyro_rad_s = 0.0, largest_accel_m_s2 = 0.0;              ///< of any axis in this recording
  double still_at_start_s = 0.0;  ///< until the first sample above 0.2 rad/s or 1 m/s^2 off gravity
};

/// Of the first lidar.
struct LidarFacts {
  std::string device;
  bool livox = false;                                    ///< by the device's name
  bool timed = false;                                    ///< points have times of their own
  std::size_t sweeps = 0, empty_sweeps = 0, points = 0;  ///< the empty ones are among the sweeps
  double period_s = 0.0;
  int rings = 1;                             ///< one more than the highest
  int columns = 1;                           ///< firings of a ring in a sweep, from the median step between its returns
  double nearest_m = 0.0, farthest_m = 0.0;  ///< of the returns
  /// What is nearer belongs to the robot: the rig's cage reaches 0.7 m from its lidar (the box that the mapper leaves
  /// out); else the nearest return.
  double own_body_m = 0.0;
};

/// The sensors that a peer is given, in numbers; truth has no part in it.
struct SensorFacts {
  std::optional<ImuFacts> imu;
  std::optional<LidarFacts> lidar;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity(), T_BL = Eigen::Isometry3d::Identity();
  double gravity_m_s2 = 0.0;

  Eigen::Isometry3d T_IL() const { return T_BI.inverse(Eigen::Isometry) * T_BL; }
};

/// `points`: of each lidar, where they are set aside; null: in the records. A sweep at a time is in memory.
SensorFacts facts_of(const sim::Sensors& sensors, const std::vector<PointStore>* points = nullptr);

}  // namespace tumble::scenarios
