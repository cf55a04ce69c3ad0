// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct ImuFacts {
  std::string device;
  std::size_t samples = 0;
  double period_s = 0.0;
  double gyro_noise_rad_s_sqrt_hz = 0.0, accel_noise_m_s2_sqrt_hz = 0.0;  ///< from the data sheet; 0: not stated
  double stated_gyro_range_rad_s = 0.0, stated_accel_range_m_s2 = 0.0;    ///< from the data sheet; 0: not stated
  double largest_gyro_rad_s = 0.0, largest_accel_m_s2 = 0.0;              ///< maximum over all axes
  double still_at_start_s = 0.0;                                          ///< until 0.2 rad/s or 1 m/s^2
};

struct LidarFacts {
  std::string device;
  bool livox = false;  ///< by the device's name
  bool timed = false;
  std::size_t sweeps = 0, empty_sweeps = 0, points = 0;  ///< `sweeps` includes the empty ones
  double period_s = 0.0;
  int rings = 1;                             ///< highest ring plus one
  int columns = 1;                           ///< firings of a ring in a sweep
  double nearest_m = 0.0, farthest_m = 0.0;  ///< range of the returns
  /// Radius around the lidar in which points belong to the robot. For an unknown robot, the radius is the range of the
  /// nearest point, rounded down to 0.1 m.
  double own_body_m = 0.0;
};

struct SensorFacts {
  std::optional<ImuFacts> imu;
  std::optional<LidarFacts> lidar;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity(), T_BL = Eigen::Isometry3d::Identity();
  double gravity_m_s2 = 0.0;

  Eigen::Isometry3d T_IL() const { return T_BI.inverse(Eigen::Isometry) * T_BL; }
};

SensorFacts facts_of(const sim::Sensors& sensors, const std::vector<PointStore>* points = nullptr);

}  // namespace tumble::scenarios
