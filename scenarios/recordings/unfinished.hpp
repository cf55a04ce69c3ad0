// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Unfinished removes its file or folder if a signal of `remove_unfinished_on_signals` arrives during its lifetime.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: keeps the folder itself
  Unfinished() = default;
  /// Signal handlers remove at most 64 paths, with at most 4095 bytes each.
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

/// The handlers for SIGINT, SIGTERM and SIGHUP remove incomplete outputs. After the removal, the signals have their
/// usual effect. Ignored signals stay ignored. The handlers are async-signal-safe: they only make system calls on
/// static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
