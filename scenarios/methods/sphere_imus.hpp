// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"

/// sphere_imus.hpp prepares all IMUs of a sphere for the estimator.
namespace tumble::scenarios {

/// SphereImus contains the usable readings of the IMUs of a sphere.
struct SphereImus {
  std::vector<std::string> names;
  std::vector<UnitRecording> recordings;
  int beyond_range = 0;  ///< dropped readings beyond the range of the device
};

/// Converts all IMUs except `imu_reference`, at most ImuMerge::kImus. The function drops readings that are not finite,
/// out of order or beyond the device's range. Returns the error of the primary IMU if no IMU is valid.
Status sphere_imus(const sim::Sensors& sensors, SphereImus& out);

/// MergedImus contains the IMUs of a sphere, merged with knowledge of the whole recording.
struct MergedImus {
  MergedRecordings merged;
  std::vector<std::string> names;  ///< names of the units
  int beyond_range = 0;            ///< see SphereImus
};

/// Reports the number of dropped readings beyond the range of the device.
void report_beyond_range(int readings, const sim::Sensors& sensors, Estimate& estimate);

/// Merges all IMUs by merge_recordings().
Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
