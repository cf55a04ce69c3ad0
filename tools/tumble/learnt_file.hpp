// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/methods/rate_tumble.hpp"

namespace tumble::tools {

/// The option --learnt: a file that holds what earlier runs have learnt of the rig, and afterwards what this run has.
class LearntFile {
 public:
  /// An empty path: no option, nothing is read or kept. A file that is not there is none yet. Throws BadInput on one
  /// that cannot be read.
  explicit LearntFile(std::filesystem::path path);

  /// Full names of the methods that learn of the rig, for the user.
  static std::string learning_methods();

  /// `method` as one that starts from the file; itself where it learns nothing and without a file. It refers to this
  /// object.
  scenarios::Method wrap(const scenarios::Method& method);

  /// Writes what was learnt; leaves the file as it is where nothing was. Throws BadInput when it cannot write.
  void keep() const;

 private:
  std::filesystem::path path_;
  scenarios::Learning learning_;
};

}  // namespace tumble::tools
