// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "tumble/angular_velocity/detail/learnt_rig.hpp"

namespace tumble::scenarios {

/// Reading restores all numbers bit-exactly.
void write_rig_calibration(const std::filesystem::path& path, const CalibratedRig& rig);

CalibratedRig read_rig_calibration(const std::filesystem::path& path);

}  // namespace tumble::scenarios
