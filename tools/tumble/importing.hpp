// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/methods/lidar_rotation.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/repairable.hpp"
#include "tools/tumble/import_options.hpp"
#include "tools/tumble/session.hpp"

/// importing.hpp reads a recording of any format for `import`, `odometry` and `doctor`.
namespace tumble::tools {

/// Imports a recording of one format, with the notes of reader and checks. `rotation` receives the comparison of IMU
/// and lidar. Throws BadInput if the import fails.
scenarios::Imported import_recording(const Session& session, const ImportOptions& options, const std::string& format,
                                     scenarios::LidarRotationCheck& rotation);

/// Repair is an option that was set automatically, and the error without this option.
struct Repair {
  scenarios::ImportOption option;
  std::string cause;
};

/// OpenRecording is a recording for an estimator, with all points in memory.
struct OpenRecording {
  ImportOptions options;  ///< options of the user, with the repairs
  std::string format;     ///< import format, or "recording" for a recording of this program
  scenarios::Imported content;
  std::optional<sim::Truth> truth;  ///< reference of an imported recording, for display only
  std::vector<Repair> repairs;
  scenarios::LidarRotationCheck rotation;
};

/// Opens a recording of this program, or any file that `tumble import` reads. If an error names an option that would
/// make the recording readable and the user did not set it, the recording is read again with this option. If a bag has
/// several topics of a kind, faulty topics are skipped. Throws BadInput if the recording cannot be read.
OpenRecording open_recording(const Session& session, ImportOptions options);

}  // namespace tumble::tools
