// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>

#include "sim/recording.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// Numbers of an inertial measurement unit; the defaults are those of an ideal one at 100 Hz.
std::span<const Parameter> imu_parameters();

/// What one IMU says and what truly happened to it, from the body's truth. Signals are exact increments over each
/// physics step (mean rate, and mean specific force of the site in the axes of the middle attitude), then the device's
/// errors in the order: low-pass, scale and misalignment, bias, g-sensitivity, white noise, rail, digital low-pass,
/// mean over the output window, quantum. With `clip_after_low_pass` the rail acts on that mean. A twin with the same
/// noise and no rail gives ImuTruth's unclipped readings. `sensor.values` are resolved; `T_BI` is the true mounting.
/// Clip flags mark windows in which an axis met its rail at any moment.
/// Throws InvalidSituation when the output period is no whole number of physics steps.
/// Not modelled: jitter, drop-outs, temperature, vibration rectification, coning compensation inside of the device.
void simulate_imu(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI, double gravity_m_s2,
                  std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth);

}  // namespace tumble::sim
