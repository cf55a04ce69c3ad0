// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// What a simulated motion was like, for holding a scenario against a published campaign. From the truth alone: no
/// estimate and no lidar enter.
struct MotionSummary {
  double moving_s = 0.0;            ///< from the first to the last instant above 0.1 m/s or 0.3 rad/s
  double rest_at_end_s = 0.0;       ///< from the last such instant to the end of the recording
  double path_m = 0.0;              ///< length of the path of the centre of mass
  double peak_rate_rad_s = 0.0;     ///< largest norm of the true mean rate over a sample of the primary IMU
  double peak_accel_m_s2 = 0.0;     ///< largest norm of a reading before the rail, after the bandwidth, over all IMUs
  double flight_share = 0.0;        ///< share of moving_s without any contact
  std::size_t impacts = 0;          ///< onsets above 20 m/s^2 at the centre of mass after 20 ms below it
  std::size_t samples = 0;          ///< of the primary IMU while moving
  std::size_t clipped_samples = 0;  ///< of those with at least one gyro axis clipped (ClippingTruth)
  std::array<std::size_t, 3> axis_clipped_samples = {};  ///< per axis x, y, z
  std::size_t several_axes_samples = 0;                  ///< with two axes or more
  double clip_depth_max_rad_s = 0.0;                     ///< largest loss of an axis to the rail (ClippingTruth)
  double clip_length_max_s = 0.0;                        ///< longest segment of clipped samples in a row
  std::size_t accel_clipped_samples = 0;  ///< with a clipped accelerometer axis, by the same tolerance of its own noise
};

/// Linear in the recording's length. Throws BadInput when sensors and truth do not belong together or hold no IMU.
MotionSummary summarise_motion(const sim::Sensors& sensors, const sim::Truth& truth);

}  // namespace tumble::scenarios
