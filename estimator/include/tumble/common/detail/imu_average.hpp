// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

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

  bool operator==(const ImuAverage&) const = default;
};

struct ImuSamplePair {
  std::size_t index_before = 0,
              index_after = 0;        ///< neighbouring samples; outside of the recording, the two samples at its end
  double interpolation_weight = 0.0;  ///< weight of the later sample; not within [0, 1] outside of the recording
  double length_s = 0.0;
  bool is_inside_recording() const { return interpolation_weight >= 0.0 && interpolation_weight <= 1.0; }
};

/// Interpolates the readings of one IMU linearly at the time stamps of another IMU. Different averaging windows of the
/// two IMUs, and rotation within a window, are neglected.
class ImuInterpolation {
 public:
  /// The constructor needs at least two samples with increasing time stamps, which must outlive the object.
  explicit ImuInterpolation(std::span<const ImuSample> samples) : samples_(samples) {}

  /// Returns the neighbours of `time_ns`, which must not decrease from call to call. Cost: amortised O(1).
  ImuSamplePair samples_around(TimeNs time_ns) {
    while (index_after_ + 1 < samples_.size() && samples_[index_after_].time_ns < time_ns) ++index_after_;
    const ImuSample &a = samples_[index_after_ - 1], &b = samples_[index_after_];
    const double length_s = seconds(b.time_ns - a.time_ns);
    return {index_after_ - 1, index_after_, seconds(time_ns - a.time_ns) / length_s, length_s};
  }

  /// Returns the interpolated reading, with the clip flags of both neighbours. At the time of a sample, the result
  /// equals the sample bit for bit.
  ImuSample at(TimeNs time_ns, const ImuSamplePair& neighbours) const {
    const ImuSample &a = samples_[neighbours.index_before], &b = samples_[neighbours.index_after];
    if (a.time_ns == time_ns) return a;
    if (b.time_ns == time_ns) return b;
    const double to_a = 1.0 - neighbours.interpolation_weight, to_b = neighbours.interpolation_weight;
    return {time_ns, to_a * a.angular_velocity_rad_s + to_b * b.angular_velocity_rad_s,
            to_a * a.specific_force_m_s2 + to_b * b.specific_force_m_s2,
            static_cast<std::uint8_t>(a.device_clip_flags | b.device_clip_flags)};
  }

 private:
  std::span<const ImuSample> samples_;
  std::size_t index_after_ = 1;
};

}  // namespace tumble
