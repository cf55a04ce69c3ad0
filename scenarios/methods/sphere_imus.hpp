// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

/// All IMUs of a sphere as one.
namespace tumble::scenarios {

struct MergedImus {
  /// What was learnt of one unit; offset and bias about the mean of all.
  struct Unit {
    std::string name;
    double time_offset_s = 0.0, time_offset_sigma_s = 0.0;  ///< later is positive
    double rate_bias_rad_s = 0.0;                           ///< length
  };

  std::vector<ImuSample> samples;                         ///< body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the centre of mass, body axes
  double gyro_range_rad_s = 1e3, accel_range_m_s2 = 1e5;  ///< readings from here on are taken to be at the rail
  int units = 0;
  double left_out = 0.0;      ///< readings
  int resampled = 0;          ///< units whose stamps differ from the primary one's
  double offset_max_s = 0.0;  ///< largest time offset of a unit about the mean
  std::vector<Unit> each;     ///< those in use
};

/// Merges the primary IMU with the others; `imu_reference` is not one of them. Readings with stamps of their own are
/// interpolated at the primary one's; a unit that does not cover nearly all of these, or has trouble in its samples, is
/// left out. Trouble: that of the primary one's samples. O(N).
Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
