// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "sim/recording.hpp"

namespace tumble::scenarios {

struct MotionSummary {
  double moving_s = 0.0;                                 ///< with more than 0.1 m/s or 0.3 rad/s
  double rest_at_end_s = 0.0;                            ///< after the last motion
  double path_m = 0.0;                                   ///< path of the centre of mass
  double peak_rate_rad_s = 0.0;                          ///< true rate
  double peak_accel_m_s2 = 0.0;                          ///< unclipped reading of any IMU
  double flight_share = 0.0;                             ///< fraction of moving_s
  std::size_t impacts = 0;                               ///< above 20 m/s^2 after 20 ms below
  std::size_t samples = 0;                               ///< samples of the primary IMU during motion
  std::size_t clipped_samples = 0;                       ///< with at least one clipped gyro axis
  std::array<std::size_t, 3> axis_clipped_samples = {};  ///< per axis x, y, z
  std::size_t several_axes_samples = 0;                  ///< with at least two clipped axes
  std::size_t cross_axis_samples = 0;                    ///< clipped, with cross-axis error
  double clip_depth_max_rad_s = 0.0;                     ///< largest saturation deficit of an axis
  double clip_length_max_s = 0.0;                        ///< longest sequence of clipped samples
  std::size_t accel_clipped_samples = 0;                 ///< samples with a clipped accelerometer axis
};

MotionSummary summarise_motion(const sim::Sensors& sensors, const sim::Truth& truth);

}  // namespace tumble::scenarios
