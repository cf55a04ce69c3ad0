// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/replace_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw BadInput(path.string() + ": cannot be written: " + std::generic_category().message(error));
}

/// A new file beside `path`, removed again unless it was moved into place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& path) : path_(path) {
    std::string stem(".");
    stem.append(path.filename().string()).append(".").append(std::to_string(getpid())).append(".");
    for (int attempt = 0; attempt < 1000 && descriptor_ < 0; ++attempt) {
      name_ = path.parent_path() / (stem + std::to_string(attempt) + ".tmp");
      descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) fail(path_, errno);
    }
    if (descriptor_ < 0) fail(path_, EEXIST);
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!moved_) unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write_all(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written =
          write(descriptor_, bytes.data(), std::min<std::size_t>(bytes.size(), std::size_t{1} << 30));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  void move_into_place() {
    // a full disk may show only here, when the system has promised more than it has
    if (fsync(descriptor_) < 0) fail(path_, errno);
    if (close(std::exchange(descriptor_, -1)) < 0) fail(path_, errno);
    if (rename(name_.c_str(), path_.c_str()) < 0) fail(path_, errno);
    moved_ = true;
  }

 private:
  std::filesystem::path path_;
  std::filesystem::path name_;
  int descriptor_ = -1;
  bool moved_ = false;
};

}  // namespace

void replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(path);
  file.write_all(bytes);
  file.move_into_place();
}

void replace_file(const std::filesystem::path& path, std::string_view text) {
  replace_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace tumble::scenarios
