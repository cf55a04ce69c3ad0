// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

inline constexpr const char* kUnfinished = ".unfinished";

/// UnfinishedFolder is an incomplete folder, WITHIN/.unfinished/NAME, which the destructor removes unless the folder
/// was moved to its final path.
class UnfinishedFolder {
 public:
  UnfinishedFolder(const std::filesystem::path& place, const std::filesystem::path& within);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void move_into_place();

 private:
  std::filesystem::path place_, path_;
  bool moved_ = false;
};

}  // namespace tumble::scenarios
