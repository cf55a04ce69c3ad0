// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// unfinished.hpp removes incomplete outputs when a signal ends the process.
namespace tumble::scenarios {

/// Unfinished is an incomplete file or folder. During the object's lifetime, a signal of `remove_unfinished_on_signals`
/// removes the file, or the folder with its content. Only the process that created the object removes the path, not its
/// child processes.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: an existing folder that itself remains
  Unfinished() = default;
  /// Signals do not remove paths longer than 4095 bytes, and remove at most 64 paths.
  Unfinished(const std::filesystem::path& path, Kind kind);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  /// Keeps the path from now on.
  void keep();

 private:
  int place_ = -1;
};

/// SignalsWait blocks the signals of `remove_unfinished_on_signals` during the object's lifetime. SignalsWait protects
/// a new path that has no Unfinished object yet.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// Installs the signal handlers. SIGINT, SIGTERM and SIGHUP, unless ignored, remove incomplete outputs and then have
/// their usual effect. The handlers are async-signal-safe: they only make system calls on static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
