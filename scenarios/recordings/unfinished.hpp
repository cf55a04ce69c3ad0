// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// What a process has in the making beside its place, and what a signal that ends the process does with it.
namespace tumble::scenarios {

/// A file or a folder in the making. While one lives it is removed, a folder with all that came into it, when a signal
/// of `remove_unfinished_on_signals` ends this process; the process that made it alone removes it, no child of its.
class Unfinished {
 public:
  enum class Kind { file, folder, contents };  ///< contents: of a folder that was there before, and stays
  Unfinished() = default;
  /// A path of more than 4095 bytes, or one beyond the 64 that are kept at a time, is not removed on signals.
  Unfinished(const std::filesystem::path& path, Kind kind);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  /// From now on it stays.
  void keep();

 private:
  int place_ = -1;
};

/// While one lives, those signals wait: what is made, and not yet an Unfinished, would be left.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// From now on SIGINT, SIGTERM and SIGHUP, where they are not ignored, remove what is unfinished and then have their
/// usual effect. What a handler does here is safe in one: system calls on what stands in static storage.
void remove_unfinished_on_signals();

}  // namespace tumble::scenarios
