// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/exchange/lidar_rotation.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/repairable.hpp"
#include "tools/tumble/import_options.hpp"
#include "tools/tumble/session.hpp"

/// importing.hpp reads a recording of any format for `import`, `odometry` and `doctor`.
namespace tumble::tools {

/// Imports a recording of one format with the notes of the reader and of the checks. `rotation` receives the comparison
/// of IMU and lidar. Throws BadInput.
scenarios::Imported import_recording(const Session& session, const ImportOptions& options, const std::string& format,
                                     scenarios::LidarRotationCheck& rotation);

/// Repair is an option that was set automatically, with the error that occurs without it.
struct Repair {
  scenarios::ImportOption option;
  std::string cause;
};

/// OpenRecording is a recording that is ready for an estimator, with all points in memory.
struct OpenRecording {
  ImportOptions options;  ///< as given, with the repairs
  std::string format;     ///< format of the import, or "recording" for a recording of this program
  scenarios::Imported content;
  std::optional<sim::Truth> truth;  ///< reference of an imported recording, for display only
  std::vector<Repair> repairs;
  scenarios::LidarRotationCheck rotation;
};

/// Opens a recording of this program, or any file that `tumble import` reads. If an error names an option that repairs
/// the reading, and the user did not set the option, the recording is read again with the option. If a bag has several
/// topics, faulty topics are left out. Throws BadInput.
OpenRecording open_recording(const Session& session, ImportOptions options);

}  // namespace tumble::tools
