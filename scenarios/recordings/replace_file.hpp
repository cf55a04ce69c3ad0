// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "scenarios/recordings/unfinished.hpp"

/// Everything that is written goes through here: beside its place and then renamed, only over regular files.
namespace tumble::scenarios {

/// A file in the making: a new one beside its place, removed again unless it was moved there, also when a signal ends
/// the program (unfinished.hpp). A symbolic link is
/// followed. What stands there already must be a regular file that may be written; its mode and owner are kept. Throws
/// BadInput with the path and the system's reason (no such folder, no permission, disk full, a device, a pipe).
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where it is in the making, for libraries that write by name.
  const std::filesystem::path& unfinished() const { return unfinished_; }
  void write(std::span<const std::byte> bytes);
  /// Flushes it to the disk and renames it, so that the path holds the old file or the whole new one.
  void move_into_place();

 private:
  std::filesystem::path given_, place_, unfinished_;
  std::optional<Unfinished> on_signal_;
  bool moved_ = false;
};

/// A folder of outputs: absent, or empty. Throws BadInput when it holds anything: what an earlier run left would be
/// taken for this one's. Unless it is kept, what came into it is removed again, and the folder itself where it was made
/// here; so also when a signal ends the program.
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

/// Puts `bytes` into an OutputFile.
void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replace_file(const std::filesystem::path& path, std::string_view text);

/// Refuses an output that is one of the inputs, by whatever name (the same device and inode), or that stands already in
/// a folder that is one. Throws BadInput.
void require_not_an_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

}  // namespace tumble::scenarios
