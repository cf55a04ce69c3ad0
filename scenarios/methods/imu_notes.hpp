// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2);

std::vector<std::string> imu_notes(const Imported& recording);

}  // namespace tumble::scenarios
