// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Where folders in the making stand, within the one that holds those that are done.
inline constexpr const char* kUnfinished = ".unfinished";

/// A folder in the making, WITHIN/.unfinished/NAME, until it is moved to its place whole; gone when it is not. One
/// process at a time makes what belongs to one place. Throws std::filesystem::filesystem_error.
class UnfinishedFolder {
 public:
  UnfinishedFolder(const std::filesystem::path& place, const std::filesystem::path& within);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// In the place of what stands there.
  void move_into_place();

 private:
  std::filesystem::path place_, path_;
  bool moved_ = false;
};

}  // namespace tumble::scenarios
