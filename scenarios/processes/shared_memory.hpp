// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// SharedMemory is anonymous shared memory, which a program inherits as a file descriptor and which is freed when its
/// last user ends.
class SharedMemory {
 public:
  explicit SharedMemory(const char* name);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  int descriptor() const { return descriptor_; }
  void append(std::span<const std::byte> bytes);
  void seal();
  std::size_t size() const;
  std::string contents() const;

 private:
  int descriptor_ = -1;
};

}  // namespace tumble::scenarios
