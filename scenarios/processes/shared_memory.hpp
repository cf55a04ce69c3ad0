// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tumble::scenarios {

/// SharedMemory is anonymous shared memory, which a child program inherits as a file descriptor. The shared memory is
/// freed when the last process that uses the memory ends.
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
