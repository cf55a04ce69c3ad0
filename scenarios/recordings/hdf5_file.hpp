// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scenarios/recordings/hdf5_group.hpp"
#include "scenarios/recordings/hdf5_layout.hpp"

/// HDF5 files. Every error is BadInput "FILE: PLACE: what". Private to scenarios/recordings.
namespace tumble::scenarios::hdf5 {

/// A file opened for reading.
class InputFile {
 public:
  /// Throws BadInput: missing, not HDF5, truncated.
  explicit InputFile(const std::filesystem::path& path);
  const Group& root() const { return root_; }

 private:
  Silence silence_;
  Handle file_;
  Group root_;
};

/// A file composed in memory. The library cannot recover from a failed close, so it must never meet a full disk.
class MemoryFile {
 public:
  /// Messages start with `name`.
  explicit MemoryFile(const std::string& name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const Group& root() const { return root_; }
  /// Closes the file with all its objects and returns its bytes, valid during the lifetime of this object.
  std::span<const std::byte> close();

 private:
  Silence silence_;
  std::string name_;
  void* image_ = nullptr;  ///< set by the library's driver when the file closes
  Handle file_;
  Group root_;
};

/// A file written to disk, replacing an empty one. Reserves the maximum space first, so that the library never meets a
/// full disk.
class DiskFile {
 public:
  /// Messages start with `name`. Throws BadInput if there is not enough space.
  DiskFile(const std::string& name, const std::filesystem::path& path, std::uint64_t most_bytes);
  ~DiskFile();
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;

  const Group& root() const { return root_; }
  /// Closes the file with all its objects and releases unused space.
  void close();

 private:
  Silence silence_;
  std::string name_;
  std::filesystem::path path_;
  Handle file_;
  Group root_;
};

}  // namespace tumble::scenarios::hdf5
