// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/processes/command.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "scenarios/processes/process.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kWords = 300, kTranscript = 524'288;

void limit(int resource, double value) {
  const auto most = static_cast<rlim_t>(value);
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void become(const Command& command, std::string& problem) {
  signal(SIGINT, SIG_DFL);
  signal(SIGHUP, SIG_DFL);
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
  for (const int descriptor : command.descriptors) fcntl(descriptor, F_SETFD, 0);  // keep open across exec
  for (const auto& [name, value] : command.environment) setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> words;
  for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  // The memory limit of a command is set last. The forked child process is a copy of this program, whose memory may
  // already exceed the limit.
  limit(RLIMIT_DATA, command.memory_limit_mib * kMib);
  execvp(words.front(), words.data());
  problem = command.words.front() + ": " + strerror(errno);
}

std::string ends_of(const std::filesystem::path& path, std::size_t most) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  const auto size = static_cast<std::size_t>(file.tellg());
  std::string text(std::min(size, most), '\0');
  file.seekg(0).read(text.data(), static_cast<std::streamsize>(text.size()));
  if (size > most) {
    std::string last(std::min(size - most, most), '\0');
    file.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end);
    file.read(last.data(), static_cast<std::streamsize>(last.size()));
    text += (size > 2 * most ? " ... " : "") + last;
  }
  return text;
}

std::string words_of(const std::string& transcript) {
  std::string text = transcript;
  if (text.size() > 2 * kWords) text = text.substr(0, kWords) + " ... " + text.substr(text.size() - kWords);
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
  end.transcript = ends_of(command.transcript, kTranscript);
  end.output_tail = words_of(end.transcript);
  end.cpu_s = last.cpu_s;
  if (!problem.empty()) {
    end.how = CommandEnd::How::not_started;
    end.reason = "cannot be started: " + problem;
  } else if (!ended) {
    end.how = CommandEnd::How::timed_out;
    end.reason = fmt::format("the command did not end within its time limit of {} s",
                             static_cast<long long>(command.time_limit_s));
  } else if (!last.normal) {
    end.how = CommandEnd::How::failed;
    end.reason = last.describe();
  }
  return end;
}

}  // namespace tumble::scenarios
