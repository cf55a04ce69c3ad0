// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

/// Subfolder for incomplete folders, next to the complete folders.
inline constexpr const char* kUnfinished = ".unfinished";

/// UnfinishedFolder is an incomplete folder, WITHIN/.unfinished/NAME. The destructor removes it unless it was moved to
/// its final path. Only one process at a time may create a folder NAME. Throws std::filesystem::filesystem_error if the
/// folder cannot be created.
class UnfinishedFolder {
 public:
  UnfinishedFolder(const std::filesystem::path& place, const std::filesystem::path& within);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Moves the folder to its final path; an existing folder there is replaced.
  void move_into_place();

 private:
  std::filesystem::path place_, path_;
  bool moved_ = false;
};

}  // namespace tumble::scenarios
