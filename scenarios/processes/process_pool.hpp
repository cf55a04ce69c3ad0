// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

#include "scenarios/processes/process.hpp"

namespace tumble::scenarios {

struct PoolOptions {
  int jobs = 1;          ///< number of processes at a time
  double limit_s = 0.0;  ///< time limit of each process [s]
  const std::atomic<bool>* stop = nullptr;
};

/// PooledEnd is the end of one process: everything that the process wrote, and how it ended.
struct PooledEnd {
  std::size_t index = 0;
  std::string said;
  bool late = false;  ///< the process was killed at its time limit
  Process::End end;
};

/// Runs `work(index, write_end)` for each index below `count` in a separate process. Calls `on_end` in the calling
/// process whenever a process ends. When `stop` becomes true, the running processes are killed, and `on_end` is not
/// called for them. Throws BadInput if no process can be started.
void run_in_processes(std::size_t count, const PoolOptions& options, const std::function<void(std::size_t, int)>& work,
                      const std::function<void(const PooledEnd&)>& on_end);

}  // namespace tumble::scenarios
