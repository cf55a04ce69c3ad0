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

/// The axes of a unit that froze, and when, in order of axis and time (FrozenAxes). `samples` are those of `record`.
/// O(N).
std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples);

}  // namespace tumble::scenarios
