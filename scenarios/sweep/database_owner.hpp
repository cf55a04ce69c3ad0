// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/recordings/unfinished.hpp"

namespace tumble::scenarios {

/// DatabaseOwner has exclusive write access to a results database by a lock (flock) on the file FILE.lock; readers need
/// no lock. The operating system releases the file lock when the process ends.
class DatabaseOwner {
 public:
  explicit DatabaseOwner(const std::filesystem::path& database);
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
