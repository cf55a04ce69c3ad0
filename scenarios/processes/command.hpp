// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// A program of somebody else's with its words, and what it may use.
struct Command {
  std::vector<std::string> words;                  ///< the program, looked for in PATH, and its arguments; no shell
  std::filesystem::path folder;                    ///< it starts in
  std::map<std::string, std::string> environment;  ///< added to ours
  std::filesystem::path transcript;                ///< file for what it prints and complains, replaced
  std::vector<int> descriptors = {};               ///< of ours that it is given, by their numbers
  double time_limit_s = 600.0;                     ///< of wall time
  double memory_limit_mib = 8192.0;                ///< of data of each of its processes (RLIMIT_DATA)
};

/// How a command came to its end.
struct CommandEnd {
  enum class How { done, failed, out_of_time, not_started };
  How how = How::done;
  std::string reason;      ///< one line; empty when done
  std::string last_words;  ///< the transcript on one line: its first and last 300 characters
  std::string transcript;  ///< of a long one the first and the last half MiB
  double cpu_s = 0.0;      ///< of the command, its own children not counted
};

/// Runs the command to its end, in a process group of its own that dies with it; at the limit of time the whole group
/// is killed. It dies with this process. Throws std::system_error when no process can be made.
CommandEnd run_command(const Command& command);

}  // namespace tumble::scenarios
