// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace tumble::tools {

/// While it lives, the first Ctrl-C (SIGINT) or SIGTERM sets a flag instead of ending the program; the second one ends
/// it. One at a time.
class InterruptFlag {
 public:
  InterruptFlag();
  ~InterruptFlag();
  InterruptFlag(const InterruptFlag&) = delete;
  InterruptFlag& operator=(const InterruptFlag&) = delete;

  const std::atomic<bool>& raised() const;
};

}  // namespace tumble::tools
