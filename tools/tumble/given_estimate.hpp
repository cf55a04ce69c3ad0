// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// Reads an estimate that the command line names in addition to its recording.
namespace tumble::tools {

/// Returns the frame of the poses in a TUM file: the named frame, else the first IMU, else the body if there is no IMU.
/// Throws BadInput that suggests the nearest known frame.
scenarios::Frame frame_of(const std::string& name, bool has_imu);

/// An estimate states the digest of its sensors. Throws BadInput if that is not the recording's digest.
void require_own(const std::filesystem::path& estimate, const std::filesystem::path& recording,
                 const sim::Sensors& sensors);

}  // namespace tumble::tools
