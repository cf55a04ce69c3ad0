// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/imu/imu_simulation.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {

inline constexpr double kGravity_m_s2 = 9.80665;

using Numbers = std::initializer_list<std::pair<const char*, double>>;

/// Returns an IMU without errors, except that these numbers differ.
inline SensorSpec imu_with(Numbers numbers = {}, double rate_hz = 100.0) {
  SensorSpec sensor;
  sensor.name = "imu";
  sensor.kind = "imu";
  Values given;
  given.set("output_rate_hz", rate_hz);
  sensor.values = resolve("sensors.imu", given, imu_parameters());
  for (const auto& [name, value] : numbers) sensor.values.set(name, value);
  return sensor;
}

/// A SimulatedImu contains a device's readings and the truth.
struct SimulatedImu {
  ImuRecord record;
  ImuTruth truth;
};

inline SimulatedImu simulated(const Truth& truth, const SensorSpec& sensor,
                              const Isometry3d& T_BI = Eigen::Isometry3d::Identity(), std::uint64_t seed = 1) {
  SimulatedImu out;
  simulate_imu(truth, sensor, T_BI, kGravity_m_s2, seed, out.record, out.truth);
  return out;
}

}  // namespace tumble::sim
