// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenarios/recordings/unfinished.hpp"

namespace tumble::scenarios {

/// ScratchFolder is removed with the object, even if a signal ends the program.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& use);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<Unfinished> on_signal_;
};

}  // namespace tumble::scenarios
