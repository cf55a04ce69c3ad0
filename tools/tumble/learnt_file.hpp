// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/rate_tumble.hpp"
#include "sim/recording.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// LearntFile implements the option --learnt: a file with the calibration of the rig from earlier runs. After the run,
/// the file contains the calibration of this run.
class LearntFile {
 public:
  /// Reads the calibration file; an empty path means that the option is not used. A missing file means that there is no
  /// calibration yet. Throws BadInput if the file cannot be read.
  explicit LearntFile(std::filesystem::path path);

  /// Throws BadInput if the file cannot be written. The caller calls require_place before the run, after creating the
  /// folder of the file.
  void require_place() const;

  /// Compares the lever arm in the file with the lever arm of the recording; returns a warning if the file belongs to
  /// another rig, else "". The check matters because a rate beyond saturation depends on the lever arm, and a
  /// calibrated lever arm is accepted with an accuracy of millimetres.
  std::string caution(const sim::Sensors& sensors) const;

  /// Returns the full names of the methods that calibrate the rig.
  static std::string learning_methods();

  /// Returns a method that starts with the calibration in the file. If `method` does not calibrate or there is no file,
  /// the function returns `method` unchanged. The returned method refers to the LearntFile.
  scenarios::Method wrap(const scenarios::Method& method);

  /// Writes the calibration to the file. If the run produced no calibration, the file is unchanged and a note states
  /// the reason. Throws BadInput if writing fails.
  void keep(const Session& session) const;

 private:
  std::filesystem::path path_;
  scenarios::RigCalibrationUse learning_;
};

}  // namespace tumble::tools
