// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenarios/recordings/hdf5_group.hpp"

namespace tumble::scenarios::hdf5 {

class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path);
  const Group& root() const { return root_; }

 private:
  Silence silence_;
  Handle file_;
  Group root_;
};

/// DiskFile reserves the maximum disk space first, because the HDF5 library cannot recover from a write to a full disk.
class DiskFile {
 public:
  DiskFile(const std::string& name, const std::filesystem::path& path, std::uint64_t most_bytes);
  ~DiskFile();
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;

  const Group& root() const { return root_; }
  void close();

 private:
  Silence silence_;
  std::string name_;
  std::filesystem::path path_;
  Handle file_;
  Group root_;
};

/// Checks in a child process that the HDF5 library can open every object and attribute of a file, because HDF5 1.10 may
/// crash on damaged files. The cost is O(number of objects); dataset contents are not read.
void require_survivable(const std::filesystem::path& path);

}  // namespace tumble::scenarios::hdf5
