// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/recordings/unfinished.hpp"

namespace tumble::scenarios {

/// DatabaseOwner has exclusive write access to a results database. A second process that tries to write reports the
/// conflict and exits. Readers need no lock. The lock (flock) is on the file FILE.lock next to the database, whose text
/// names the owner. The operating system releases the lock when the process ends. A signal that ends the program
/// removes the lock file (unfinished.hpp); the lock file of a killed program is reused. On a shared file system, the
/// lock works between machines if the file system supports locks.
class DatabaseOwner {
 public:
  /// Locks the database. Throws BadInput if another process owns it, or if the lock file cannot be created. The message
  /// contains process, machine and start time of the owner.
  explicit DatabaseOwner(const std::filesystem::path& database);
  /// Releases the lock and removes the lock file.
  ~DatabaseOwner();
  DatabaseOwner(const DatabaseOwner&) = delete;
  DatabaseOwner& operator=(const DatabaseOwner&) = delete;

  const std::filesystem::path& database() const { return database_; }

 private:
  std::filesystem::path database_, lock_;
  std::optional<Unfinished> on_signal_;
  int fd_ = -1;
};

}  // namespace tumble::scenarios
