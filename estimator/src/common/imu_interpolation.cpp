// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/detail/imu_interpolation.hpp"

namespace tumble {

ImuSamplePair ImuInterpolation::samples_around(TimeNs time_ns) {
  while (index_after_ + 1 < samples_.size() && samples_[index_after_].time_ns < time_ns) ++index_after_;
  const ImuSample &a = samples_[index_after_ - 1], &b = samples_[index_after_];
  const double length_s = seconds(b.time_ns - a.time_ns);
  return {index_after_ - 1, index_after_, seconds(time_ns - a.time_ns) / length_s, length_s};
}

ImuSample ImuInterpolation::at(TimeNs time_ns, const ImuSamplePair& neighbours) const {
  const ImuSample &a = samples_[neighbours.index_before], &b = samples_[neighbours.index_after];
  if (a.time_ns == time_ns) return a;
  if (b.time_ns == time_ns) return b;
  const double to_a = 1.0 - neighbours.interpolation_weight, to_b = neighbours.interpolation_weight;
  return {time_ns, to_a * a.angular_velocity_rad_s + to_b * b.angular_velocity_rad_s,
          to_a * a.specific_force_m_s2 + to_b * b.specific_force_m_s2,
          static_cast<std::uint8_t>(a.device_clip_flags | b.device_clip_flags)};
}

}  // namespace tumble
