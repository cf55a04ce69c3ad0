// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace tumble::tools {

/// While an instance exists, the first Ctrl-C (SIGINT) or SIGTERM sets a flag; the second ends the program. SIGHUP
/// always sets the flag, because a closing terminal may send it twice (shell and system). An ignored SIGHUP (nohup)
/// stays ignored. Only one instance may exist at a time.
class InterruptFlag {
 public:
  InterruptFlag();
  ~InterruptFlag();
  InterruptFlag(const InterruptFlag&) = delete;
  InterruptFlag& operator=(const InterruptFlag&) = delete;

  const std::atomic<bool>& raised() const;
};

}  // namespace tumble::tools
