// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/processes/command.hpp"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>

#include "scenarios/processes/process.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kLastWords = 300;

void limit(int resource, double value) {
  const auto most = static_cast<rlim_t>(value);
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

/// In the child. Returns only when the program cannot be started; `problem` then says why.
void become(const Command& command, std::string& problem) {
  signal(SIGINT, SIG_DFL);
  signal(SIGPIPE, SIG_DFL);
  if (chdir(command.folder.c_str()) != 0) {
    problem = command.folder.string() + ": " + strerror(errno);
    return;
  }
  const int out = open(command.transcript.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (out < 0 || in < 0 || dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(out, STDERR_FILENO) < 0) {
    problem = command.transcript.string() + ": " + strerror(errno);
    return;
  }
  for (const int descriptor : command.descriptors) fcntl(descriptor, F_SETFD, 0);  // open beyond exec
  for (const auto& [name, value] : command.environment) setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> words;
  for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  // last, since this copy of the program may be larger than what the command may have: nothing is allocated below it
  limit(RLIMIT_DATA, command.memory_limit_mib * kMib);
  execvp(words.front(), words.data());
  problem = command.words.front() + ": " + strerror(errno);
}

std::string end_of(const std::filesystem::path& transcript) {
  std::ifstream file(transcript, std::ios::binary | std::ios::ate);
  if (!file) return {};
  const auto size = static_cast<std::streamoff>(file.tellg());
  file.seekg(std::max<std::streamoff>(0, size - static_cast<std::streamoff>(kLastWords)));
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

CommandEnd run_command(const Command& command) {
  Process process(
      [&](int fd) {
        std::string problem;
        become(command, problem);
        write_all(fd, problem);
        _exit(127);
      },
      true);
  const bool ended = process.ends_before(now_s() + command.time_limit_s);
  if (!ended) process.kill();
  const Process::End last = process.wait();
  std::string problem;
  process.read_available(problem);

  CommandEnd end;
  end.last_words = end_of(command.transcript);
  end.cpu_s = last.cpu_s;
  if (!problem.empty()) {
    end.how = CommandEnd::How::not_started;
    end.reason = "cannot be started: " + problem;
  } else if (!ended) {
    end.how = CommandEnd::How::out_of_time;
    end.reason = "no end within " + std::to_string(static_cast<long long>(command.time_limit_s)) + " s";
  } else if (!last.normal) {
    end.how = CommandEnd::How::failed;
    end.reason = last.describe();
  }
  return end;
}

}  // namespace tumble::scenarios
