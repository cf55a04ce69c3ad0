// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "scenarios/recordings/unfinished.hpp"

/// Atomic output: writes next to the final path, then renames; only replaces regular files.
namespace tumble::scenarios {

/// A file under construction next to its final path. Removed unless moved there, also when a signal ends the program
/// (unfinished.hpp). Follows symbolic links. An existing target must be a writable regular file; its mode and owner are
/// kept. Throws BadInput with the path and the system's reason (no such folder, no permission, disk full, a device, a
/// pipe).
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Returns the temporary path, for libraries that write by name.
  const std::filesystem::path& unfinished() const { return unfinished_; }
  void write(std::span<const std::byte> bytes);
  /// Flushes the file to disk and renames it, so that the path always has the complete old or new file.
  void move_into_place();

 private:
  std::filesystem::path given_, place_, unfinished_;
  std::optional<Unfinished> on_signal_;
  bool moved_ = false;
};

/// An output folder, which must be missing or empty, so that old files are not mistaken for new ones. Throws BadInput
/// otherwise. Unless kept, its content is removed, and the folder too if it was created here, also when a signal ends
/// the program.
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

/// Writes `bytes` by an OutputFile.
void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);

/// Throws BadInput if the output is one of the inputs (same device and inode), or exists within an input folder.
void require_not_an_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

}  // namespace tumble::scenarios
