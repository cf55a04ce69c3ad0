// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "scenarios/recordings/unfinished.hpp"

namespace tumble::scenarios {

/// OutputFile writes a temporary file, and moves the complete temporary file to the final path. A temporary file that
/// is not moved to the final path is removed, even if a signal ends the program. OutputFile follows symbolic links, and
/// keeps mode and owner of an existing file.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& unfinished() const { return unfinished_; }
  void write(std::span<const std::byte> bytes);
  /// Flushes the temporary file to disk and renames the temporary file, so that the final path always contains the
  /// complete old or new file.
  void move_into_place();

 private:
  std::filesystem::path given_, place_, unfinished_;
  std::optional<Unfinished> on_signal_;
  bool moved_ = false;
};

/// OutputFolder creates an output folder. A non-empty existing folder throws BadInput, because users could mistake old
/// files for new ones. The content of an incomplete output folder is removed, even if a signal ends the program.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  const std::filesystem::path& path() const { return folder_; }
  void keep() {
    kept_ = true;
    on_signal_.reset();
  }

 private:
  std::filesystem::path folder_;
  std::optional<Unfinished> on_signal_;
  bool made_ = false, kept_ = false;
};

void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);

/// Throws BadInput if the output is one of the inputs (equal device and inode) or exists in an input folder.
void require_not_an_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

}  // namespace tumble::scenarios
