// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

/// Plausibility notes on imported IMUs, with the estimator's checks (ImuPlausibility), so that users see problems
/// before estimating.
namespace tumble::scenarios {

/// Returns a warning if an IMU repeats one reading, has permuted axes, or if its force or rotation contradicts gravity;
/// "" otherwise. `gravity_m_s2`: the recording's. O(N).
std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2);

/// Returns notes on each IMU of a recording, starting with its name.
std::vector<std::string> imu_notes(const Imported& recording);

}  // namespace tumble::scenarios
