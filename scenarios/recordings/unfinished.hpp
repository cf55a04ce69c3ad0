// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// Removes incomplete outputs when a signal ends the process.
namespace tumble::scenarios {

/// An incomplete file or folder. During its lifetime, a signal of `remove_unfinished_on_signals` removes it, with all
/// content of a folder. Only the process that created it removes it, not its children.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: an existing folder that itself remains
  Unfinished() = default;
  /// Paths longer than 4095 bytes, and more than 64 at a time, are not removed on signals.
  Unfinished(const std::filesystem::path& path, Kind kind);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  /// Keeps the path from now on.
  void keep();

 private:
  int place_ = -1;
};

/// Blocks these signals during its lifetime, while a path exists that is not yet an Unfinished.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// Installs handlers: SIGINT, SIGTERM and SIGHUP, unless ignored, remove incomplete outputs and then have their usual
/// effect. The handlers are async-signal-safe: only system calls on static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
