// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"

/// sphere_imus.hpp converts the readings of all IMUs of a sphere for the estimator.
namespace tumble::scenarios {

/// SphereImus contains the usable readings of the IMUs of a sphere.
struct SphereImus {
  std::vector<std::string> names;
  std::vector<UnitRecording> recordings;
  int beyond_range = 0;  ///< number of readings that were dropped because they exceed the device's range
};

/// Converts the readings of all IMUs except `imu_reference`, at most ImuMerge::kImus IMUs. Readings that are not
/// finite, out of order or beyond the device's range are dropped. If no IMU has valid readings, returns the error of
/// the primary IMU.
Status sphere_imus(const sim::Sensors& sensors, SphereImus& out);

/// MergedImus contains the merged readings of a sphere's IMUs, computed from the whole recording.
struct MergedImus {
  MergedRecordings merged;
  std::vector<std::string> names;  ///< names of the IMUs
  int beyond_range = 0;            ///< see SphereImus
};

/// Adds the number of dropped readings beyond the range of the device to the estimate's health.
void report_beyond_range(int readings, Estimate& estimate);

/// Merges the readings of all IMUs of a sphere by merge_recordings().
Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
