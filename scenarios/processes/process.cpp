// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/processes/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace tumble::scenarios {

namespace {

[[noreturn]] void run_child(const std::function<void(int)>& work, int fd, pid_t parent, bool own_group) {
  if (own_group) setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  // SIGPIPE is ignored, so that write() returns an error if the reader has closed the pipe.
  signal(SIGINT, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  signal(SIGTERM, SIG_DFL);
  signal(SIGPIPE, SIG_IGN);
  int code = 0;
  try {
    work(fd);
  } catch (...) {
    code = 1;
  }
  _exit(code);
}

}  // namespace

void limit_memory(double mib) {
  rlimit both{};
  getrlimit(RLIMIT_DATA, &both);
  both.rlim_cur = std::min({both.rlim_cur, both.rlim_max, static_cast<rlim_t>(mib * kMib)});
  setrlimit(RLIMIT_DATA, &both);
}

std::string Process::End::describe() const {
  if (signal != 0) return "ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  return "ended with exit status " + std::to_string(exit_code);
}

bool Process::End::killed() const {
  return signal == SIGKILL || signal == SIGXCPU || signal == SIGTERM;
}

Process::Process(const std::function<void(int)>& work, bool own_group) : own_group_(own_group) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    throw std::system_error(error, std::generic_category(), "fork");
  }
  if (pid_ == 0) {
    close(ends[0]);
    run_child(work, ends[1], parent, own_group_);
  }
  if (own_group_) setpgid(pid_, pid_);
  close(ends[1]);
  fd_ = ends[0];
  fcntl(fd_, F_SETFL, O_NONBLOCK);
}

Process::~Process() {
  if (pid_ > 0) {
    kill();
    wait();
  }
  if (fd_ >= 0) close(fd_);
}

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), fd_(std::exchange(other.fd_, -1)), own_group_(other.own_group_) {}

bool Process::read_available(std::string& buffer) {
  char chunk[8192];
  while (true) {
    const ssize_t count = read(fd_, chunk, sizeof(chunk));
    if (count > 0)
      buffer.append(chunk, static_cast<std::size_t>(count));
    else if (count == 0)
      return false;
    else if (errno == EINTR)
      continue;
    else
      return errno == EAGAIN || errno == EWOULDBLOCK;
  }
}

bool Process::ends_before(double deadline_s) {
  long pause_ns = 500'000;  // first pause, for processes that end soon
  while (pid_ > 0) {
    siginfo_t info{};
    const int asked = waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
    if (asked != 0 && errno != EINTR) return true;
    if (asked == 0 && info.si_pid == pid_) return true;
    if (now_s() >= deadline_s) return false;
    const timespec pause{0, pause_ns};
    nanosleep(&pause, nullptr);
    pause_ns = std::min(2 * pause_ns, 20'000'000L);
  }
  return true;
}

void Process::kill() {
  if (pid_ > 0) ::kill(own_group_ ? -pid_ : pid_, SIGKILL);
}

Process::End Process::wait() {
  End end;
  if (pid_ <= 0) return end;
  int status = 0;
  rusage usage{};
  pid_t collected;
  do collected = wait4(pid_, &status, 0, &usage);
  while (collected < 0 && errno == EINTR);
  if (own_group_) ::kill(-pid_, SIGKILL);
  pid_ = -1;
  end.cpu_s = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
              1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  end.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (collected > 0 && WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (collected > 0 && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.normal = collected > 0 && end.signal == 0 && end.exit_code == 0;
  return end;
}

bool write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = write(fd, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace tumble::scenarios
