// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/unfinished_folder.hpp"

#include <system_error>

namespace tumble::scenarios {

UnfinishedFolder::UnfinishedFolder(const std::filesystem::path& place, const std::filesystem::path& within)
    : place_(place),
      path_(within / kUnfinished / (place.parent_path().filename().string() + "-" + place.filename().string())) {
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

UnfinishedFolder::~UnfinishedFolder() {
  std::error_code ignored;
  if (!moved_) std::filesystem::remove_all(path_, ignored);
}

void UnfinishedFolder::move_into_place() {
  std::filesystem::create_directories(place_.parent_path());
  std::filesystem::remove_all(place_);
  std::filesystem::rename(path_, place_);
  moved_ = true;
}

}  // namespace tumble::scenarios
