// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace tumble::tools {

/// While it lives, the first Ctrl-C (SIGINT) or SIGTERM sets a flag instead of ending the program; the second one ends
/// it. SIGHUP, of a terminal that closes, sets it however often it comes (shell and system both send it), unless it is
/// ignored (nohup). One at a time.
class InterruptFlag {
 public:
  InterruptFlag();
  ~InterruptFlag();
  InterruptFlag(const InterruptFlag&) = delete;
  InterruptFlag& operator=(const InterruptFlag&) = delete;

  const std::atomic<bool>& raised() const;
};

}  // namespace tumble::tools
