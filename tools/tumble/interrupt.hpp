// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace tumble::tools {

class InterruptFlag {
 public:
  InterruptFlag();
  ~InterruptFlag();
  InterruptFlag(const InterruptFlag&) = delete;
  InterruptFlag& operator=(const InterruptFlag&) = delete;

  const std::atomic<bool>& raised() const;
};

}  // namespace tumble::tools
