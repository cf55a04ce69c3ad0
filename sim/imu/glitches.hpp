// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "sim/imu/imu_chain.hpp"
#include "sim/parameters.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Replaces one axis of single samples by a wrong reading, as an error on the IMU's data bus does. The wrong reading is
/// independent of the signal, and uniform within 1.5 times the stated range. Runs of several wrong samples and wrong
/// time stamps are not simulated.
class Glitches {
 public:
  Glitches(const Values& values, const Stream& stream);
  /// Call once for each IMU sample, delivered or lost.
  void spoil(TriadReading& gyro, TriadReading& accel);

 private:
  double share_, gyro_range_rad_s_, accel_range_m_s2_;
  Stream stream_;
};

}  // namespace tumble::sim
