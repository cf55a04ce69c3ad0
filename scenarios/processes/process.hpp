// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

namespace tumble::scenarios {

/// A child process that writes to a pipe. The child dies with its parent, leaves no core file, and never returns into
/// the caller's code. Linux only.
class Process {
 public:
  struct End {
    bool normal = false;  ///< exit status 0
    int signal = 0;       ///< that ended it, 0 when none did
    int exit_code = 0;
    double cpu_s = 0;              ///< used by the child, its own children not counted
    double peak_mib = 0;           ///< largest resident size
    std::string describe() const;  ///< "ended by signal 11 (Segmentation fault)"
    /// Ended by something outside: SIGKILL (the system short of memory, an operator), SIGTERM, a quota of time.
    bool killed() const;
  };

  /// Forks and runs `work(write_end)` in the child, in a process group of its own when `own_group`. What `work` throws
  /// ends the child with exit status 1. Throws std::system_error when no process can be made.
  explicit Process(const std::function<void(int)>& work, bool own_group);
  /// The same for a child that is told something: `work(read_end, write_end)` reads what `tell` writes.
  explicit Process(const std::function<void(int, int)>& work, bool own_group);
  /// Kills (the whole group) and collects what still runs.
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  int read_end() const { return fd_; }
  /// Writes all of `text` to a child that is told something; false when it reads no more.
  bool tell(const std::string& text);
  /// Appends what the pipe holds. False at its end.
  bool read_available(std::string& buffer);
  /// Waits until it has ended, which wait() then tells; false at the deadline (of now_s()).
  bool ends_before(double deadline_s);
  void kill();
  End wait();

 private:
  void start(const std::function<void(int)>& work);

  pid_t pid_ = -1;
  int fd_ = -1;
  int told_fd_ = -1;  ///< our end of the socket that it reads
  bool own_group_ = false;
};

inline constexpr double kMib = 1024.0 * 1024.0;  ///< bytes

/// Of this process and of those that it makes: at most so much data (RLIMIT_DATA) each, and never more than whoever
/// started it allows. What needs more is refused: std::bad_alloc, or no process.
void limit_memory(double mib);

/// Writes all of `text`; false when the reader is gone.
bool write_all(int fd, const std::string& text);

/// Monotonic time [s].
double now_s();

}  // namespace tumble::scenarios
