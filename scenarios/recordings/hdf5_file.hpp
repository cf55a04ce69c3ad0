// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scenarios/recordings/hdf5_group.hpp"
#include "scenarios/recordings/hdf5_layout.hpp"

/// Files of HDF5. Every failure is BadInput "FILE: PLACE: what". Private to scenarios/recordings.
namespace tumble::scenarios::hdf5 {

/// A file opened for reading.
class InputFile {
 public:
  /// Throws BadInput: absent, not HDF5, truncated.
  explicit InputFile(const std::filesystem::path& path);
  const Group& root() const { return root_; }

 private:
  Silence silence_;
  Handle file_;
  Group root_;
};

/// A file composed in memory, so that the library never meets a full disk (it does not recover from a failed close).
class MemoryFile {
 public:
  /// `name` begins the messages.
  explicit MemoryFile(const std::string& name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const Group& root() const { return root_; }
  /// Closes the file with all that is open in it; its bytes, valid while this lives. Nothing may be written afterwards.
  std::span<const std::byte> close();

 private:
  Silence silence_;
  std::string name_;
  void* image_ = nullptr;  ///< set by the library's driver when the file closes
  Handle file_;
  Group root_;
};

/// A file composed on the disk, in the place of an empty one. The room that it will need at most is taken first, so
/// that the library does not meet a full disk here either.
class DiskFile {
 public:
  /// `name` begins the messages. Throws BadInput: no room.
  DiskFile(const std::string& name, const std::filesystem::path& path, std::uint64_t most_bytes);
  ~DiskFile();
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;

  const Group& root() const { return root_; }
  /// Closes the file with all that is open in it and gives back the room that it did not need.
  void close();

 private:
  Silence silence_;
  std::string name_;
  std::filesystem::path path_;
  Handle file_;
  Group root_;
};

}  // namespace tumble::scenarios::hdf5
