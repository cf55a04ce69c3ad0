// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "tumble/common/types.hpp"

namespace tumble {

/// Function of the caller that runs body(0) to body(count - 1) once each, in any order and on any threads, and returns
/// when all calls are done. Without a ParallelFor, the calling thread does all work. Results are bit-identical for any
/// number of threads.
using ParallelFor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

inline void run_parallel(const ParallelFor& parallel_for, std::size_t count,
                         const std::function<void(std::size_t)>& body) {
  if (parallel_for && count > 1) {
    parallel_for(count, body);
  } else {
    for (std::size_t i = 0; i < count; ++i) body(i);
  }
}

}  // namespace tumble
