// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/imu.hpp"

/// Detects single axes of an IMU that repeat one reading.
namespace tumble::scenarios {

/// An axis whose reading is bit-identical over an interval while the other axes of the triad change.
struct FrozenAxis {
  Triad triad = Triad::gyro;
  int axis = 0;
  TimeNs from_ns = 0, to_ns = 0;  ///< first and last sample with this reading
};

/// Returns the axis name for a health key, for example "gyro_z".
std::string to_string(const FrozenAxis& frozen);

/// Returns the frozen axes of an IMU with their intervals, sorted by axis and time (FrozenAxes). `samples` must be the
/// converted samples of `record`. O(N).
std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples);

}  // namespace tumble::scenarios
