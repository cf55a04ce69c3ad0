// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <fmt/format.h>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "scenarios/recordings/unfinished.hpp"
#include "tools/tumble/arguments.hpp"

namespace tumble::tools {

class GateDatabase {
 public:
  explicit GateDatabase(const std::filesystem::path& named) : path_(named), own_(named.empty()) {
    if (own_) {
      path_ = std::filesystem::temp_directory_path() / fmt::format("tumble_gate_{}.db", getpid());
      on_signal_.emplace(path_, scenarios::Unfinished::Kind::file);
    } else if (path_.has_parent_path()) {
      make_folder(path_.parent_path());
    }
  }
  ~GateDatabase() {
    std::error_code ignored;
    if (own_) std::filesystem::remove(path_, ignored);
  }
  GateDatabase(const GateDatabase&) = delete;
  GateDatabase& operator=(const GateDatabase&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool own_;
  std::optional<scenarios::Unfinished> on_signal_;
};

}  // namespace tumble::tools
