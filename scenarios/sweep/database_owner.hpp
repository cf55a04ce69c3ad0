// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/recordings/unfinished.hpp"

namespace tumble::scenarios {

/// The one that writes to a results database: a second sweep on it, or a merge into it, says so and leaves. The lock
/// (flock) is on FILE.lock beside it, which says who holds it; the system lets go of it when the process ends, however
/// it ends. A signal that ends the program takes the file away (unfinished.hpp); one that a killed program has left
/// behind is taken over. Reading needs no owner. Where the file system
/// is shared, it holds between machines as far as its locks do.
class DatabaseOwner {
 public:
  /// Throws BadInput: another owns it (its process, machine and since when), or no file can be made there.
  explicit DatabaseOwner(const std::filesystem::path& database);
  /// Lets go, and takes the file away.
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
