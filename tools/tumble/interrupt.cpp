// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/interrupt.hpp"

#include <csignal>

namespace tumble::tools {

namespace {

// a signal handler reaches nothing but static storage
std::atomic<bool> raised_by_signal{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

extern "C" void raise_flag(int) {
  raised_by_signal.store(true);
}

}  // namespace

InterruptFlag::InterruptFlag() {
  raised_by_signal.store(false);
  struct sigaction action = {};
  action.sa_handler = raise_flag;
  action.sa_flags = SA_RESETHAND;  // the second one has its usual effect
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

InterruptFlag::~InterruptFlag() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& InterruptFlag::raised() const {
  return raised_by_signal;
}

}  // namespace tumble::tools
