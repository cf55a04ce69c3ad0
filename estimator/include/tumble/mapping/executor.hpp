// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "tumble/common/detail/compiled_alike.hpp"  // IWYU pragma: keep

namespace tumble {

/// Runs body(0) to body(count - 1), each once, in any order and on any threads of the caller's, and returns when all
/// are done. The library starts no thread by itself: where it is given none of these, the calling thread does the work.
/// Work is cut the same way however many threads there are, so that results are bit-identical.
using ParallelFor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// By `parallel_for`, or in order where it is empty.
inline void run_parallel(const ParallelFor& parallel_for, std::size_t count,
                         const std::function<void(std::size_t)>& body) {
  if (parallel_for && count > 1) {
    parallel_for(count, body);
  } else {
    for (std::size_t i = 0; i < count; ++i) body(i);
  }
}

}  // namespace tumble
