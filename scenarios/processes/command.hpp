// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble::scenarios {

struct Command {
  std::vector<std::string> words;                  ///< program (in PATH) and arguments; no shell
  std::filesystem::path folder;                    ///< working folder
  std::map<std::string, std::string> environment;  ///< added to the environment
  std::filesystem::path transcript;                ///< standard output and error; replaced
  std::vector<int> descriptors = {};               ///< descriptors that the command inherits
  double time_limit_s = 600.0;                     ///< limit of the wall time
  double memory_limit_mib = 8192.0;                ///< of each process (RLIMIT_DATA)
};

struct CommandEnd {
  enum class How { done, failed, timed_out, not_started };
  How how = How::done;
  std::string reason;       ///< one line; empty on success
  std::string output_tail;  ///< first and last 300 characters
  std::string transcript;   ///< first and last half MiB
  double cpu_s = 0.0;       ///< without child processes
};

/// Runs a command in a separate process group. The whole process group is killed at the time limit, or when the calling
/// process ends.
CommandEnd run_command(const Command& command);

}  // namespace tumble::scenarios
