// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/imu.hpp"

/// Single axes of an IMU that have stopped reading.
namespace tumble::scenarios {

/// One axis of a triad that repeats one reading to the last bit while the others of the triad move.
struct FrozenAxis {
  Triad triad = Triad::gyro;
  int axis = 0;
  TimeNs from_ns = 0, to_ns = 0;  ///< first and last sample with that reading
};

/// "gyro_z", as a part of a row of an estimate's health.
std::string to_string(const FrozenAxis& frozen);

/// Longest time for which a healthy axis may repeat its reading while the body moves [s].
inline constexpr double kAxisFrozen_s = 0.5;

/// The axes of a unit that froze, and when: a reading that lasts for kAxisFrozen_s and ten times as long as any did
/// before, after as long of readings that change, while the body turns (or is pushed) by far more than a quantum of the
/// axis and another axis of the triad changes from sample to sample. Not told from that: an axis that never moved or
/// held its reading as long before (a coarse quantum at rest, a simulation without noise). A reading at the rail, at
/// 0.9 of the stated range, flagged by the device, or the highest or lowest of the axis from 0.5 of the range on, may
/// repeat. `samples` are those of `record`. O(N).
std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples);

}  // namespace tumble::scenarios
