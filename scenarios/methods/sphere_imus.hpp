// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

/// All IMUs of a sphere as one.
namespace tumble::scenarios {

struct MergedImus {
  std::vector<ImuSample> samples;                         ///< body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the centre of mass, body axes
  double gyro_range_rad_s = 1e3, accel_range_m_s2 = 1e5;  ///< readings from here on are taken to be at the rail
  int units = 0;
  double left_out = 0.0;      ///< readings
  double offset_max_s = 0.0;  ///< largest time offset of a unit about the mean
};

/// Merges the primary IMU with those that share its time stamps; `imu_reference` is not one of them. Trouble: that of
/// the primary one's samples. O(N).
Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
