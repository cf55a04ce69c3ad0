// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

/// The functions in imu_notes.hpp check the readings of imported IMUs (check_readings), so that users see problems
/// before they run an estimator.
namespace tumble::scenarios {

/// Returns a warning if an IMU repeats one reading, or measures a force or rotation that contradicts gravity; otherwise
/// returns "". The parameter `gravity_m_s2` is the gravity of the recording. The cost is O(N).
std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2);

/// Returns a warning for each IMU of a recording whose readings are implausible. Each warning starts with the IMU's
/// name.
std::vector<std::string> imu_notes(const Imported& recording);

}  // namespace tumble::scenarios
