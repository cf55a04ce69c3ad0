// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "sim/imu/elements.hpp"
#include "sim/imu/imu_parameters.hpp"
#include "sim/recording.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

struct GivenElements {
  std::optional<Elements> gyro, accel;
};

/// Simulates the readings of an IMU. The ideal rate is the rotation over the averaging window, divided by its duration.
/// The ideal specific force is the mean acceleration of the IMU minus gravity, in the axes halfway through the
/// rotation. The ideal readings integrate to the true motion at any output rate, also through impacts.
///
/// The unclipped readings in ImuTruth have the same noise as the readings, but no saturation. Temperature, vibration
/// rectification and bending of the mount are not simulated.
///
/// A clip flag marks the axis of a sensing element that was saturated at any moment of the averaging window. Because of
/// misalignment compensation, a saturated sensing element also falsifies the readings of axes without a clip flag.
void simulate_imu(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI, double gravity_m_s2,
                  std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth, const GivenElements& given = {});

/// Simulates the readings of an IMU at rest. The sensor errors are simulated at the rate `chain_rate_hz` instead of the
/// physics rate. With `chain_rate_hz` = 500, the simulation of one hour takes about one second. The bandwidths of the
/// device must be 0 or below half of `chain_rate_hz`.
void simulate_imu_at_rest(const SensorSpec& sensor, double duration_s, double chain_rate_hz, double gravity_m_s2,
                          std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth);

}  // namespace tumble::sim
