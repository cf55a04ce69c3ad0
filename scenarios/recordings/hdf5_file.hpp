// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scenarios/recordings/hdf5_group.hpp"
#include "scenarios/recordings/hdf5_layout.hpp"

/// hdf5_file.hpp opens and writes HDF5 files. Every error is a BadInput with the message "FILE: PLACE: what". Used only
/// within scenarios/recordings.
namespace tumble::scenarios::hdf5 {

/// InputFile is an HDF5 file opened for reading.
class InputFile {
 public:
  /// Throws BadInput if the file is missing, truncated, or not HDF5.
  explicit InputFile(const std::filesystem::path& path);
  const Group& root() const { return root_; }

 private:
  Silence silence_;
  Handle file_;
  Group root_;
};

/// MemoryFile is an HDF5 file composed in memory. The HDF5 library cannot recover from a failed close, so it must never
/// write to a full disk.
class MemoryFile {
 public:
  /// Error messages start with `name`.
  explicit MemoryFile(const std::string& name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const Group& root() const { return root_; }
  /// Closes the file with all HDF5 objects and returns the file's bytes. The bytes are valid during the lifetime of
  /// this object.
  std::span<const std::byte> close();

 private:
  Silence silence_;
  std::string name_;
  void* image_ = nullptr;  ///< set by the library's driver when the file closes
  Handle file_;
  Group root_;
};

/// DiskFile is an HDF5 file that is written directly to disk and replaces an empty file. The maximum disk space is
/// reserved first, so that the HDF5 library never writes to a full disk.
class DiskFile {
 public:
  /// Error messages start with `name`. Throws BadInput if there is not enough space.
  DiskFile(const std::string& name, const std::filesystem::path& path, std::uint64_t most_bytes);
  ~DiskFile();
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;

  const Group& root() const { return root_; }
  /// Closes the file with all HDF5 objects and releases unused disk space.
  void close();

 private:
  Silence silence_;
  std::string name_;
  std::filesystem::path path_;
  Handle file_;
  Group root_;
};

}  // namespace tumble::scenarios::hdf5
