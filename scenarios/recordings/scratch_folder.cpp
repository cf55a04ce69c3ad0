// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/scratch_folder.hpp"

#include <stdlib.h>

#include <cerrno>
#include <system_error>

namespace tumble::scenarios {

ScratchFolder::ScratchFolder(const std::string& use) {
  const SignalsWait until_listed;
  std::string name = (std::filesystem::temp_directory_path() / ("tumble-" + use + "-XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::filesystem::filesystem_error("cannot create a temporary folder", name, {errno, std::generic_category()});
  path_ = name;
  on_signal_.emplace(path_, Unfinished::Kind::folder);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tumble::scenarios
