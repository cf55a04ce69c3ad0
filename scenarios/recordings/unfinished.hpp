// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// The classes in unfinished.hpp remove incomplete outputs when a signal ends the process.
namespace tumble::scenarios {

/// Unfinished registers an incomplete file or folder for removal. If a signal of `remove_unfinished_on_signals` arrives
/// during the object's lifetime, the file, or the folder with its content, is removed. Only the process that created
/// the object removes the path, and not its child processes.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: an existing folder that itself remains
  Unfinished() = default;
  /// Registers a path; signals remove at most 64 paths, with at most 4095 bytes each.
  Unfinished(const std::filesystem::path& path, Kind kind);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  /// Ends the registration, so that signals no longer remove the path.
  void keep();

 private:
  int place_ = -1;
};

/// SignalsWait delays the signals of `remove_unfinished_on_signals` during the object's lifetime. SignalsWait protects
/// a new path that is not yet registered with Unfinished.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// Installs handlers for the signals SIGINT, SIGTERM and SIGHUP, unless they are ignored. The handlers remove
/// incomplete outputs; the signals then have their usual effect. The handlers are async-signal-safe: they only make
/// system calls on static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
