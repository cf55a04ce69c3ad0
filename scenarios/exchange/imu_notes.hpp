// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

/// Checks imported IMUs with the estimator's plausibility checks (ImuPlausibility), so that users see problems before
/// they run an estimator.
namespace tumble::scenarios {

/// Returns a warning if an IMU repeats one reading, has permuted axes, or measures a force or rotation that contradicts
/// gravity; otherwise "". `gravity_m_s2` is the gravity of the recording. O(N).
std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2);

/// Returns notes on each IMU of a recording. Each note starts with the IMU's name.
std::vector<std::string> imu_notes(const Imported& recording);

}  // namespace tumble::scenarios
