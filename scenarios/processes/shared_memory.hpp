// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// Memory that a program is given by its descriptor (Command::descriptors): no file of any folder, gone with its last
/// user. Linux only. Throws std::system_error when there is no room.
class SharedMemory {
 public:
  /// Empty. `name` is for those who look into /proc.
  explicit SharedMemory(const char* name);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  int descriptor() const { return descriptor_; }
  void append(std::span<const std::byte> bytes);
  /// From now on nobody, a child neither, can change it.
  void seal();
  std::size_t size() const;
  /// All that is in it, read through its start.
  std::string contents() const;

 private:
  int descriptor_ = -1;
};

}  // namespace tumble::scenarios
