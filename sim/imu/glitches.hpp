// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "sim/imu/imu_chain.hpp"
#include "sim/parameters.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Glitches simulates errors on the IMU's data bus, which replace one axis of a single sample by a wrong reading. The
/// wrong reading is independent of the signal, and uniform within 1.5 times the stated range. The simulation does not
/// include sequences of several wrong samples, and wrong time stamps.
class Glitches {
 public:
  Glitches(const Values& values, const Stream& stream);
  /// The caller must call spoil() once for each IMU sample, even if the sample is lost.
  void spoil(TriadReading& gyro, TriadReading& accel);

 private:
  double share_, gyro_range_rad_s_, accel_range_m_s2_;
  Stream stream_;
};

}  // namespace tumble::sim
