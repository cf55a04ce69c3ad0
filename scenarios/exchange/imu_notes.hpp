// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

/// What an imported IMU's readings show against themselves, as the estimators ask it (ImuPlausibility): whoever imports
/// learns it before an estimate rests on it.
namespace tumble::scenarios {

/// A caution on an IMU that repeats one reading, whose axes are named otherwise than gravity turns in them, or whose
/// force or turning is not gravity's; "" where nothing is to be said. `gravity_m_s2`: the recording's. O(N).
std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2);

/// Of each IMU of a recording, its name before it.
std::vector<std::string> imu_notes(const Imported& recording);

}  // namespace tumble::scenarios
