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

/// Sensing elements of a device that is known, as one that was measured; a triad without is drawn from `sensor.values`.
struct GivenElements {
  std::optional<Elements> gyro, accel;
};

/// What one IMU says and what truly happened to it, from the body's truth. The ideal reading of a window is the exact
/// increment over it: the rotation between the attitudes at its ends over its length, and the change of the site's
/// velocity less gravity in the axes of the attitude half-way; their integral is the true motion through impacts too,
/// at any output rate. The errors of the device come on top, in this order (each stage is documented where it lives):
///
///   lever arm and mounting (truth/record_truth.hpp), delay, analogue low-pass, scale and misalignment, bias,
///   g-sensitivity, white noise of the part in range, sensing elements, rail, compensation of the elements
///   (elements.hpp), quantum, digital low-pass, mean over the window (imu_chain.hpp), stamps and losses
///   (time_stamps.hpp); magnetometer.hpp for the magnetic field.
///
/// A twin with the same noise and no rail gives ImuTruth's unclipped readings. `sensor.values` are resolved; `T_BI` is
/// the true mounting. Clip flags mark windows in which an element met its rail at any moment; with
/// tilted elements the axes beside it are wrong too, unflagged. A lost sample is lost from
/// the truth too. `given` elements change no other draw. Throws InvalidSituation when the output period is no whole
/// number of physics steps, or numbers contradict each other. What it does not model: temperature, vibration
/// rectification, bending of the mount.
void simulate_imu(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI, double gravity_m_s2,
                  std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth, const GivenElements& given = {});

/// The same device at rest, z up, for `duration_s`: no engine, no body, no magnetometer. The chain runs at
/// `chain_rate_hz` instead of the physics rate (a low one is fast: an hour at 500 Hz takes about a second); the
/// analogue and digital bandwidths of the device must lie below half of it or be 0. For measuring noise figures.
void simulate_imu_at_rest(const SensorSpec& sensor, double duration_s, double chain_rate_hz, double gravity_m_s2,
                          std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth);

}  // namespace tumble::sim
