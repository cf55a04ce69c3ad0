// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/diagnosis/lidar_rotation.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/repairable.hpp"
#include "tools/tumble/import_options.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

scenarios::Imported import_recording(const Session& session, const ImportOptions& options, const std::string& format,
                                     scenarios::LidarRotationCheck& rotation);

struct Repair {
  scenarios::ImportOption option;
  std::string cause;
};

struct OpenRecording {
  ImportOptions options;  ///< options of the user, with the repairs
  std::string format;     ///< "recording": of this program
  scenarios::Imported content;
  std::optional<sim::Truth> truth;  ///< for display only
  std::vector<Repair> repairs;
  std::string digest;  ///< of the sensors as `tumble import` stores them
  scenarios::LidarRotationCheck rotation;
};

/// If an error names an option that would make the recording readable and the user did not set it, the recording is
/// read again with this option.
OpenRecording open_recording(const Session& session, ImportOptions options);

}  // namespace tumble::tools
