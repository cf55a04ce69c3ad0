// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "scenarios/recordings/unfinished.hpp"

/// replace_file.hpp writes output atomically: to a temporary file next to the final path, which is then renamed. Only
/// regular files are replaced.
namespace tumble::scenarios {

/// OutputFile is a temporary output file next to its final path. A temporary file that is not moved to the final path
/// is removed, even if a signal ends the program (unfinished.hpp). After SIGKILL, it remains until the next process
/// writes to the folder. OutputFile follows symbolic links. An existing target must be a writable regular file; its
/// mode and owner are kept. Throws BadInput with the path and the system's reason (missing folder, no permission, disk
/// full, a device, a pipe).
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Returns the path of the temporary file, for libraries that write to a named file.
  const std::filesystem::path& unfinished() const { return unfinished_; }
  void write(std::span<const std::byte> bytes);
  /// Flushes the file to disk and renames it. The final path always has the complete old or new file.
  void move_into_place();

 private:
  std::filesystem::path given_, place_, unfinished_;
  std::optional<Unfinished> on_signal_;
  bool moved_ = false;
};

/// OutputFolder is a folder for all files of one output. The folder must be missing or empty, so that users do not
/// mistake old files for new ones. Throws BadInput if the folder is not empty. The content of an incomplete output is
/// removed, even if a signal ends the program. If OutputFolder created the folder, it is removed too.
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

/// Writes `bytes` to a file atomically, with an OutputFile.
void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);

/// Throws BadInput if the output is one of the inputs (equal device and inode) or exists in an input folder.
void require_not_an_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

}  // namespace tumble::scenarios
