// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/interrupt.hpp"

#include <csignal>

namespace tumble::tools {

namespace {

// A signal handler may only use static storage.
std::atomic<bool> raised_by_signal{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler needs a lock-free atomic variable");

struct sigaction interrupt_before = {}, terminate_before = {}, hang_up_before = {};

/// A second Ctrl-C or SIGTERM has its previous effect; only SIGHUP sets the flag again.
extern "C" void raise_flag(int number) {
  raised_by_signal.store(true);
  if (number != SIGHUP) sigaction(number, number == SIGINT ? &interrupt_before : &terminate_before, nullptr);
}

}  // namespace

InterruptFlag::InterruptFlag() {
  raised_by_signal.store(false);
  struct sigaction action = {};
  action.sa_handler = raise_flag;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, nullptr, &interrupt_before);
  sigaction(SIGTERM, nullptr, &terminate_before);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, nullptr, &hang_up_before);
  if (hang_up_before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

InterruptFlag::~InterruptFlag() {
  sigaction(SIGINT, &interrupt_before, nullptr);
  sigaction(SIGTERM, &terminate_before, nullptr);
  sigaction(SIGHUP, &hang_up_before, nullptr);
}

const std::atomic<bool>& InterruptFlag::raised() const {
  return raised_by_signal;
}

}  // namespace tumble::tools
