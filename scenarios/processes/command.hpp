// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Command is an external program with its arguments and limits.
struct Command {
  std::vector<std::string> words;                  ///< the program, searched in PATH, and its arguments; no shell
  std::filesystem::path folder;                    ///< working folder
  std::map<std::string, std::string> environment;  ///< added to our environment
  std::filesystem::path transcript;                ///< file for its standard output and error; replaced
  std::vector<int> descriptors = {};               ///< our file descriptors that it inherits
  double time_limit_s = 600.0;                     ///< wall time
  double memory_limit_mib = 8192.0;                ///< data of each of its processes (RLIMIT_DATA)
};

/// CommandEnd describes how a command ended.
struct CommandEnd {
  enum class How { done, failed, timed_out, not_started };
  How how = How::done;
  std::string reason;       ///< one line; empty on success
  std::string output_tail;  ///< transcript on one line: first and last 300 characters
  std::string transcript;   ///< first and last half MiB of a long transcript
  double cpu_s = 0.0;       ///< of the command without its children
};

/// Runs the command in a separate process group and waits for its end. At the time limit, the function kills the whole
/// process group. The process group is also killed when this process ends. Throws std::system_error if no process can
/// be started.
CommandEnd run_command(const Command& command);

}  // namespace tumble::scenarios
