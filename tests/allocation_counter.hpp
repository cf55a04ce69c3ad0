// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <malloc.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

// This header replaces the global operators `new` and `delete`, so exactly one source of a program may include it.

namespace tumble::test {

/// Counts the allocations of this thread.
struct AllocationCounter {
  std::size_t count = 0;
  std::size_t bytes = 0, peak_bytes = 0;  ///< allocated now, and at most
};
inline thread_local AllocationCounter allocations;

}  // namespace tumble::test

// the functions are not inlined, so that the compiler does not report mismatched new and delete
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  tumble::test::AllocationCounter& counter = tumble::test::allocations;
  ++counter.count;
  counter.bytes += malloc_usable_size(memory);
  counter.peak_bytes = std::max(counter.peak_bytes, counter.bytes);
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // std::stable_sort uses it
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  tumble::test::allocations.bytes -= malloc_usable_size(memory);
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  tumble::test::allocations.bytes -= malloc_usable_size(memory);
  std::free(memory);
}
