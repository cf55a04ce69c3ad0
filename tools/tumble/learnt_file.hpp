// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/rate_tumble.hpp"
#include "sim/recording.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

/// The option --learnt: a file that holds what earlier runs have learnt of the rig, and afterwards what this run has.
class LearntFile {
 public:
  /// An empty path: no option, nothing is read or kept. A file that is not there is none yet. Throws BadInput on one
  /// that cannot be read.
  explicit LearntFile(std::filesystem::path path);

  /// Throws BadInput where the file could not be written: before a run has cost anything, and once its folder is there,
  /// in which the file may be. Leaves nothing.
  void require_place() const;

  /// Whether what the file held is of another rig than the recording says its IMU is on: a caution, or "". Rates beyond
  /// a rail rest on the lever arm, and what was learnt is believed to millimetres.
  std::string caution(const sim::Sensors& sensors) const;

  /// Full names of the methods that learn of the rig, for the user.
  static std::string learning_methods();

  /// `method` as one that starts from the file; itself where it learns nothing and without a file. It refers to this
  /// object.
  scenarios::Method wrap(const scenarios::Method& method);

  /// Writes what was learnt. Where nothing was, the file stays as it is, and a note says so and why. Throws BadInput
  /// when it cannot write.
  void keep(const Session& session) const;

 private:
  std::filesystem::path path_;
  scenarios::Learning learning_;
};

}  // namespace tumble::tools
