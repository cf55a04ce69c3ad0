// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/database_owner.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <string>
#include <system_error>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_lock(const fs::path& path, int error) {
  throw BadInput(path.string() + ": cannot be locked: " + std::generic_category().message(error));
}

fs::path lock_of(const fs::path& database) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(database, error);
  if (error) place = database;
  place += ".lock";
  return place;
}

std::string who_we_are() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  std::array<char, 32> since{};
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  std::strftime(since.data(), since.size(), "%Y-%m-%d %H:%M:%S UTC", gmtime_r(&now, &parts));
  return "process " + std::to_string(getpid()) + " on " + host.data() + " since " + since.data();
}

std::string who_holds(int fd) {
  std::array<char, 400> text{};
  const ssize_t length = pread(fd, text.data(), text.size() - 1, 0);
  std::string line(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  line.resize(std::min(line.size(), line.find_first_of("\r\n")));
  return line.empty() ? "another process" : line;
}

/// Returns true if `path` is still the lock file that this process opened. Another process may have removed the lock
/// file in the meantime.
bool is_at(const fs::path& path, int fd) {
  struct stat open {
  }, named{};
  return fstat(fd, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

}  // namespace

DatabaseOwner::DatabaseOwner(const fs::path& database) : database_(database), lock_(lock_of(database)) {
  const SignalsWait until_listed;
  for (int attempt = 0; attempt < 100; ++attempt) {
    const int fd = open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd < 0) fail_to_lock(lock_, errno);
    if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string holder = who_holds(fd);
      close(fd);
      if (error != EWOULDBLOCK) fail_to_lock(lock_, error);
      throw BadInput(
          fmt::format("{}: {} is writing to this database; choose another file, or wait until that process ends",
                      database.string(), holder));
    }
    if (is_at(lock_, fd)) {
      fd_ = fd;
      break;
    }
    close(fd);
  }
  if (fd_ < 0) fail_to_lock(lock_, EAGAIN);
  on_signal_.emplace(lock_, Unfinished::Kind::file);
  const std::string text = who_we_are() + "\n";
  if (ftruncate(fd_, 0) == 0 && pwrite(fd_, text.data(), text.size(), 0) < 0) return;
}

DatabaseOwner::~DatabaseOwner() {
  on_signal_.reset();
  unlink(lock_.c_str());
  close(fd_);
}

}  // namespace tumble::scenarios
