// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// An estimate that the command line names beside its recording.
namespace tumble::tools {

/// The frame of the poses in a TUM file: as named, else of the first IMU, of the body where there is none. Throws
/// BadInput naming the nearest known one.
scenarios::Frame frame_of(const std::string& name, bool has_imu);

/// An estimate says which sensors it was made from: throws BadInput when those are not the recording's.
void require_own(const std::filesystem::path& estimate, const std::filesystem::path& recording,
                 const sim::Sensors& sensors);

}  // namespace tumble::tools
