// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/rate_tumble.hpp"
#include "sim/recording.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// LearntFile implements the option --learnt: a run starts with the rig calibration of earlier runs and writes its own
/// to this file.
class LearntFile {
 public:
  /// An empty path disables the option; a missing file contains no calibration yet.
  explicit LearntFile(std::filesystem::path path);

  /// Throws BadInput if the file cannot be written; must be called before the run.
  void require_place() const;

  std::string caution(const sim::Sensors& sensors) const;

  static std::string learning_methods();

  scenarios::Method wrap(const scenarios::Method& method);

  void keep(const Session& session) const;

 private:
  std::filesystem::path path_;
  scenarios::RigCalibrationUse learning_;
};

}  // namespace tumble::tools
