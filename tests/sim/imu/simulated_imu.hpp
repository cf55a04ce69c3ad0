// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "sim/imu/imu_simulation.hpp"

namespace tumble::sim {

inline constexpr double kGravity_m_s2 = 9.80665;

/// Readings of a device, and their truth.
struct SimulatedImu {
  ImuRecord record;
  ImuTruth truth;
};

inline SimulatedImu simulated(const Truth& truth, const SensorSpec& sensor,
                              const Eigen::Isometry3d& T_BI = Eigen::Isometry3d::Identity(), std::uint64_t seed = 1) {
  SimulatedImu out;
  simulate_imu(truth, sensor, T_BI, kGravity_m_s2, seed, out.record, out.truth);
  return out;
}

}  // namespace tumble::sim
