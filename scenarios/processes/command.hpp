// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble::scenarios {

struct Command {
  std::vector<std::string> words;                  ///< the program (found in PATH) and its arguments; no shell
  std::filesystem::path folder;                    ///< working folder
  std::map<std::string, std::string> environment;  ///< variables added to the environment of this process
  std::filesystem::path transcript;                ///< file for standard output and error; replaced if it exists
  std::vector<int> descriptors = {};               ///< file descriptors of this process that the command inherits
  double time_limit_s = 600.0;                     ///< limit of the wall time
  double memory_limit_mib = 8192.0;                ///< limit of the data of each process (RLIMIT_DATA)
};

struct CommandEnd {
  enum class How { done, failed, timed_out, not_started };
  How how = How::done;
  std::string reason;       ///< reason of a failure in one line; empty on success
  std::string output_tail;  ///< transcript in one line; first and last 300 characters
  std::string transcript;   ///< transcript; first and last half MiB of a long one
  double cpu_s = 0.0;       ///< CPU time of the command without its children
};

/// The command runs in a separate process group, which is killed at the time limit and when this process ends.
CommandEnd run_command(const Command& command);

}  // namespace tumble::scenarios
