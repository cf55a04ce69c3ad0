// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

namespace tumble::scenarios {

/// Process is a child process that writes to a pipe. The child ends when its parent ends, leaves no core file, and
/// never returns to the caller's code. Process works on Linux only.
class Process {
 public:
  struct End {
    bool normal = false;  ///< exit status 0
    int signal = 0;       ///< signal that ended the child, or 0
    int exit_code = 0;
    double cpu_s = 0;              ///< CPU time of the child without its children
    double peak_mib = 0;           ///< largest resident memory
    std::string describe() const;  ///< "ended by signal 11 (Segmentation fault)"
    /// Returns true if the child was ended from outside: by SIGKILL (out of memory, an operator), SIGTERM, or a time
    /// quota.
    bool killed() const;
  };

  /// Forks this process and runs `work(write_end)` in the child, in a separate process group if `own_group` is true. If
  /// `work` throws, the child ends with exit status 1. Throws std::system_error if no process can be started.
  explicit Process(const std::function<void(int)>& work, bool own_group);
  /// Forks this process and runs `work(read_end, write_end)` in the child. The child reads the text of `write_text`
  /// from `read_end`.
  explicit Process(const std::function<void(int, int)>& work, bool own_group);
  /// Kills the child process (or its process group) and waits for its end.
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  int read_end() const { return fd_; }
  /// Writes all of `text` to the input of the child process. Returns false if the child process has closed its input.
  bool write_text(const std::string& text);
  /// Appends the available content of the pipe to `buffer`. Returns false at the end of the pipe.
  bool read_available(std::string& buffer);
  /// Waits until the child has ended. Returns false if the child still runs at the deadline, a time of now_s(). After
  /// true, wait() returns the exit status.
  bool ends_before(double deadline_s);
  void kill();
  End wait();

 private:
  void start(const std::function<void(int)>& work);

  pid_t pid_ = -1;
  int fd_ = -1;
  int input_fd_ = -1;  ///< this process's end of the child's input socket
  bool own_group_ = false;
};

inline constexpr double kMib = 1024.0 * 1024.0;  ///< bytes in one MiB

/// Limits the data memory (RLIMIT_DATA) of this process and of each future child; the inherited limit also applies.
/// Allocations beyond the limit fail with std::bad_alloc, and new processes cannot be started.
void limit_memory(double mib);

/// Writes all of `text` to a file descriptor. Returns false if the reader has closed the pipe.
bool write_all(int fd, const std::string& text);

/// Returns the time of a monotonic clock [s].
double now_s();

}  // namespace tumble::scenarios
