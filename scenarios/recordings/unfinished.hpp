// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// unfinished.hpp removes incomplete outputs when a signal ends the process.
namespace tumble::scenarios {

/// Unfinished registers an incomplete file or folder. If a signal of `remove_unfinished_on_signals` arrives during its
/// lifetime, the file, or the folder with its content, is removed. Child processes do not remove it.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: content of an existing folder, which itself remains
  Unfinished() = default;
  /// Registers a path. Signals remove at most 64 paths, with at most 4095 bytes each.
  Unfinished(const std::filesystem::path& path, Kind kind);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  /// Ends the registration: signals then leave the path.
  void keep();

 private:
  int place_ = -1;
};

/// SignalsWait delays the signals of `remove_unfinished_on_signals` during its lifetime, to protect a new path that is
/// not yet registered with Unfinished.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// Installs handlers for SIGINT, SIGTERM and SIGHUP; ignored signals stay ignored. The handlers remove incomplete
/// outputs; the signals then have their usual effect. The handlers are async-signal-safe: they only make system calls
/// on static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
