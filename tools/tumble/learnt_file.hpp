// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/rate_tumble.hpp"
#include "sim/recording.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// LearntFile implements the option --learnt: a file with the calibration of the rig. A run starts with the calibration
/// of earlier runs and writes its own.
class LearntFile {
 public:
  /// Reads the calibration file. An empty path disables the option; a missing file contains no calibration yet. Throws
  /// BadInput if the file cannot be read.
  explicit LearntFile(std::filesystem::path path);

  /// Throws BadInput if the file cannot be written. Must be called before the run, when the folder exists.
  void require_place() const;

  /// Returns a warning if the lever arms of file and recording differ, so that the file probably belongs to another
  /// rig; otherwise empty. The check matters: rates beyond saturation depend on the lever arm, and a calibrated one is
  /// accepted with an accuracy of millimetres.
  std::string caution(const sim::Sensors& sensors) const;

  /// Returns the full names of the methods that calibrate the rig.
  static std::string learning_methods();

  /// Returns a method that starts with the calibration in the file, and refers to this LearntFile. Returns `method`
  /// unchanged if it does not calibrate or there is no file.
  scenarios::Method wrap(const scenarios::Method& method);

  /// Writes the calibration to the file. Without a new calibration, the file is unchanged and a note states the reason.
  /// Throws BadInput if writing fails.
  void keep(const Session& session) const;

 private:
  std::filesystem::path path_;
  scenarios::RigCalibrationUse learning_;
};

}  // namespace tumble::tools
