// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// Reads an estimate that the command line names in addition to the recording.
namespace tumble::tools {

/// Returns the frame of the poses in a TUM file: the frame that the user names, else the first IMU, else the body if
/// there is no IMU. Throws BadInput that suggests the nearest known frame.
scenarios::Frame frame_of(const std::string& name, bool has_imu);

/// Checks the digest of the sensor data that an estimate states. Throws BadInput if the digest is not that of the
/// recording.
void require_own(const std::filesystem::path& estimate, const std::filesystem::path& recording,
                 const sim::Sensors& sensors);

}  // namespace tumble::tools
