// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

namespace tumble::scenarios {

/// Process is a child process. The child process ends when its parent ends, leaves no core file, and never returns to
/// the caller's code.
class Process {
 public:
  struct End {
    bool normal = false;  ///< exit status 0
    int signal = 0;       ///< signal that ended the child, or 0
    int exit_code = 0;
    double cpu_s = 0;              ///< without child processes
    double peak_mib = 0;           ///< largest resident memory
    std::string describe() const;  ///< "ended by signal 11 (Segmentation fault)"
    /// Returns true if a cause outside the child process ended the child process: SIGKILL (out of memory, an operator),
    /// SIGTERM, or a time quota.
    bool killed() const;
  };

  explicit Process(const std::function<void(int)>& work, bool own_group);
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  int read_end() const { return fd_; }
  bool read_available(std::string& buffer);
  /// Waits for the end of the child process until the time `deadline_s` of the clock now_s(). Returns false if the
  /// child process is still running at `deadline_s`.
  bool ends_before(double deadline_s);
  void kill();
  End wait();

 private:
  pid_t pid_ = -1;
  int fd_ = -1;
  bool own_group_ = false;
};

inline constexpr double kMib = 1024.0 * 1024.0;  ///< bytes in one MiB

/// Limits the data memory (RLIMIT_DATA) of this process and of each future child process. Allocations beyond the memory
/// limit fail with std::bad_alloc, and new processes cannot be started.
void limit_memory(double mib);

bool write_all(int fd, const std::string& text);

double now_s();

}  // namespace tumble::scenarios
