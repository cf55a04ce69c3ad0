// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/glitches.hpp"

#include <algorithm>

namespace tumble::sim {

namespace {

constexpr double kRanges = 1.5;

}  // namespace

Glitches::Glitches(const Values& values, const Stream& stream)
    : share_(values.at("glitch_share")),
      gyro_range_rad_s_(values.at("gyro_range_rad_s")),
      accel_range_m_s2_(values.at("accel_range_m_s2")),
      stream_(stream) {}

void Glitches::spoil(TriadReading& gyro, TriadReading& accel) {
  if (share_ <= 0.0 || stream_.uniform() >= share_) return;
  const int channel = std::min(5, static_cast<int>(6.0 * stream_.uniform()));
  const double ranges = kRanges * (2.0 * stream_.uniform() - 1.0);
  TriadReading& triad = channel < 3 ? gyro : accel;
  const double reading = ranges * (channel < 3 ? gyro_range_rad_s_ : accel_range_m_s2_);
  triad.delivered[channel % 3] = triad.unclipped[channel % 3] = reading;
}

}  // namespace tumble::sim
