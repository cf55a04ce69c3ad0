// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "tumble/common/types.hpp"

namespace tumble {

/// Averages IMU readings over time windows of one length, so that a filter does not depend on the sample rate of the
/// IMU. Coning and sculling within the window are neglected.
struct ImuAverage {
  ImuSample mean;  ///< with the time stamp of the last reading and the clip flags of all readings
  double length_s = 0.0;
  double rate_peak_rad_s = 0.0;  ///< largest rate component of a single reading
  double force_peak_m_s2 = 0.0;
  std::int64_t readings = 0;

  /// Adds a reading, which is the mean over the time `dt_s` before its time stamp.
  void add(const ImuSample& sample, double dt_s) {
    length_s += dt_s;
    if (++readings == 1) {
      mean = sample;
    } else {
      const double share = dt_s / length_s;
      mean.angular_velocity_rad_s += share * (sample.angular_velocity_rad_s - mean.angular_velocity_rad_s);
      mean.specific_force_m_s2 += share * (sample.specific_force_m_s2 - mean.specific_force_m_s2);
      mean.time_ns = sample.time_ns;
      mean.device_clip_flags = static_cast<std::uint8_t>(mean.device_clip_flags | sample.device_clip_flags);
    }
    rate_peak_rad_s = std::max(rate_peak_rad_s, sample.angular_velocity_rad_s.cwiseAbs().maxCoeff());
    force_peak_m_s2 = std::max(force_peak_m_s2, sample.specific_force_m_s2.cwiseAbs().maxCoeff());
  }

  /// Returns true if the length is closer to `window_s` now than after another reading of length `dt_s`.
  bool full(double window_s, double dt_s) const { return length_s >= window_s - 0.5 * dt_s; }

  bool operator==(const ImuAverage& other) const {
    return mean.time_ns == other.mean.time_ns && mean.angular_velocity_rad_s == other.mean.angular_velocity_rad_s &&
           mean.specific_force_m_s2 == other.mean.specific_force_m_s2 &&
           mean.device_clip_flags == other.mean.device_clip_flags && length_s == other.length_s &&
           rate_peak_rad_s == other.rate_peak_rad_s && force_peak_m_s2 == other.force_peak_m_s2 &&
           readings == other.readings;
  }
};

}  // namespace tumble
