// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/unfinished.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>

namespace tumble::scenarios {

namespace {

constexpr std::size_t kPathBytes = 4096;
constexpr int kPlaces = 64, kDepthMax = 16;

/// Entry is the path of an incomplete file or folder. A signal handler ignores an Entry whose `owner` (process id) is
/// 0, so `owner` is set last and cleared first.
struct Entry {
  std::atomic<bool> taken{false};
  std::atomic<pid_t> owner{0};
  Unfinished::Kind kind = Unfinished::Kind::file;
  std::array<char, kPathBytes> path{};
};

// The entries are in static storage, because a signal handler must not allocate memory.
std::array<Entry, kPlaces> entries;
static_assert(std::atomic<pid_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler must not wait for a lock");

std::atomic<int> waiting{0}, pending{0};  // SignalsWait objects, delayed signal

/// The signal handler reads directories by the system call getdents64, because readdir allocates memory.
struct Listed {
  std::uint64_t inode;
  std::int64_t next;
  unsigned short bytes;
  unsigned char type;
  char name[1];
};

void remove_contents(int folder, int depth) {
  alignas(Listed) std::array<char, 2048> listed;
  for (long got = 1; got > 0;) {
    got = syscall(SYS_getdents64, folder, listed.data(), listed.size());
    for (long at = 0; at < got;) {
      const auto* each = reinterpret_cast<const Listed*>(listed.data() + at);
      at += each->bytes;
      if (std::strcmp(each->name, ".") == 0 || std::strcmp(each->name, "..") == 0) continue;
      if (unlinkat(folder, each->name, 0) == 0 || depth == kDepthMax) continue;
      const int inner = openat(folder, each->name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
      if (inner < 0) continue;
      remove_contents(inner, depth + 1);
      close(inner);
      unlinkat(folder, each->name, AT_REMOVEDIR);
    }
  }
}

void remove_entry(const Entry& entry) {
  if (entry.kind == Unfinished::Kind::file) {
    unlink(entry.path.data());
    return;
  }
  const int folder = open(entry.path.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  remove_contents(folder, 0);
  close(folder);
  if (entry.kind == Unfinished::Kind::folder) rmdir(entry.path.data());
}

extern "C" void remove_and_end(int number) {
  if (waiting.load() > 0) {
    pending.store(number);
    return;
  }
  const int error = errno;
  for (const Entry& entry : entries) {
    if (entry.owner.load() == getpid()) remove_entry(entry);
  }
  errno = error;
  // The signal ends the program when the signal handler returns, because the default action is restored before the
  // signal is raised again.
  struct sigaction usual = {};
  usual.sa_handler = SIG_DFL;
  sigaction(number, &usual, nullptr);
  raise(number);
}

}  // namespace

Unfinished::Unfinished(const std::filesystem::path& path, Kind kind) {
  std::error_code ignored;
  const std::string absolute = std::filesystem::absolute(path, ignored).string();
  if (ignored || absolute.size() >= kPathBytes) return;
  for (int place = 0; place < kPlaces; ++place) {
    Entry& entry = entries[static_cast<std::size_t>(place)];
    if (entry.taken.exchange(true)) continue;
    entry.kind = kind;
    std::memcpy(entry.path.data(), absolute.c_str(), absolute.size() + 1);
    entry.owner.store(getpid());
    place_ = place;
    return;
  }
}

Unfinished::~Unfinished() {
  keep();
}

void Unfinished::keep() {
  if (place_ < 0) return;
  Entry& entry = entries[static_cast<std::size_t>(place_)];
  entry.owner.store(0);
  entry.taken.store(false);
  place_ = -1;
}

SignalsWait::SignalsWait() {
  ++waiting;
}

SignalsWait::~SignalsWait() {
  if (--waiting > 0) return;
  if (const int number = pending.exchange(0); number != 0) raise(number);
}

void remove_unfinished_on_signals() {
  struct sigaction action = {};
  action.sa_handler = remove_and_end;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, number);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
}

}  // namespace tumble::scenarios
