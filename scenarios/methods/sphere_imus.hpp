// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"

namespace tumble::scenarios {

struct SphereImus {
  std::vector<std::string> names;
  std::vector<UnitRecording> recordings;
  int beyond_range = 0;  ///< readings that were dropped because they exceed the device's range
};

/// Converts at most ImuMerge::kImus IMUs, without `imu_reference`. Readings that are not finite, out of order or beyond
/// the device's range are dropped. If no IMU has valid readings, returns the error of the primary IMU.
Status sphere_imus(const sim::Sensors& sensors, SphereImus& out);

struct MergedImus {
  MergedRecordings merged;
  std::vector<std::string> names;
  int beyond_range = 0;  ///< see SphereImus
};

void report_beyond_range(int readings, Estimate& estimate);

Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
