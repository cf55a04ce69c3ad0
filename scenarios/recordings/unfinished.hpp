// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Unfinished removes its file or folder if a signal of `remove_unfinished_on_signals` arrives during its lifetime.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: keeps the folder itself
  Unfinished() = default;
  /// At most 64 paths are removed after a signal, and each path must have at most 4095 bytes.
  Unfinished(const std::filesystem::path& path, Kind kind);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  void keep();

 private:
  int place_ = -1;
};

/// SignalsWait delays signals such as SIGINT during its lifetime. Without SignalsWait, a signal between the creation of
/// a file and the construction of its Unfinished object would leave the file on the disk.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// Installs signal handlers for SIGINT, SIGTERM and SIGHUP, which remove incomplete outputs. After the removal, a
/// signal has its usual effect. Ignored signals stay ignored. The signal handlers are async-signal-safe, because they
/// only make system calls on static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
