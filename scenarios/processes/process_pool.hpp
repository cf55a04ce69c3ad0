// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "scenarios/processes/process.hpp"

namespace tumble::scenarios {

struct PoolOptions {
  int jobs = 1;  ///< number of processes at a time
  const std::atomic<bool>* stop = nullptr;
  /// The pool calls on_output() when a process may have written text. `output` contains all text of the process;
  /// on_output() may remove text that needs no further processing.
  std::function<void(std::size_t index, std::string& output)> on_output = {};
  std::function<void()> on_round = {};  ///< called several times per second
};

struct PooledWork {
  std::function<void(int)> work;  ///< writes text to this descriptor
  double limit_s = 0.0;           ///< time limit of the process [s]
};

struct PooledEnd {
  std::size_t index = 0;
  std::string output;  ///< without the text that `on_output` removed
  bool late = false;   ///< the process was killed at its time limit
  Process::End end;
};

/// Calls `next` until the result is empty, and runs each returned task in a separate process. The tasks of the pool are
/// numbered from 0. Calls `on_end` in the calling process whenever a process ends. When `stop` becomes true, the
/// running processes are killed, and `on_end` is not called for the killed processes. Throws BadInput if no process can
/// be started.
void run_in_processes(const std::function<std::optional<PooledWork>()>& next, const PoolOptions& options,
                      const std::function<void(const PooledEnd&)>& on_end);

/// Runs `work(index, write_end)` in a separate process for each index below `count`.
void run_in_processes(std::size_t count, double limit_s, const PoolOptions& options,
                      const std::function<void(std::size_t, int)>& work,
                      const std::function<void(const PooledEnd&)>& on_end);

}  // namespace tumble::scenarios
