// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/replace_file.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

constexpr int kLinksMax = 40;  // as in the operating system

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw BadInput(path.string() + ": cannot be written: " + reason);
}

[[noreturn]] void fail(const fs::path& path, int error) {
  fail(path, std::generic_category().message(error));
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  bool close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

std::optional<struct stat> status_of(const fs::path& path) {
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) return std::nullopt;
  return found;
}

fs::path behind_links(const fs::path& path) {
  fs::path place = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(place, error)); ++links) {
    if (links == kLinksMax) fail(path, ELOOP);
    const fs::path target = fs::read_symlink(place, error);
    if (error) fail(path, error.message());
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  return place;
}

void require_replaceable(const fs::path& given, const fs::path& place) {
  const std::optional<struct stat> old = status_of(place);
  if (!old) return;
  if (S_ISDIR(old->st_mode)) fail(given, EISDIR);
  if (!S_ISREG(old->st_mode)) fail(given, "the output path is a device, a pipe or a socket; it must be a regular file");
  if (access(place.c_str(), W_OK) != 0) fail(given, errno);
}

void require_outside(const fs::path& output, std::span<const fs::path> inputs) {
  std::error_code error;
  const fs::path place = fs::canonical(output, error);
  if (error) return;  // the output does not exist
  for (const fs::path& input : inputs) {
    if (!fs::is_directory(input, error)) continue;
    const fs::path folder = fs::canonical(input, error);
    if (error) continue;
    const bool within = std::mismatch(folder.begin(), folder.end(), place.begin(), place.end()).first == folder.end();
    if (within && place != folder)
      fail(output, fmt::format("the output path is one of the files in the input folder {}; choose another output name",
                               input.string()));
  }
}

std::string process_mark(const std::string& pid) {
  std::array<char, 17> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return ".tumble-" + std::string(host.data()) + "-" + pid + ".";
}

/// Removes temporary files that remain after a process on this computer was killed (SIGKILL).
void remove_abandoned(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> cleaned;
  const std::lock_guard lock(mutex);
  if (!cleaned.insert(folder).second) return;
  const std::string mark = process_mark("");
  const std::string start = mark.substr(0, mark.size() - 1);  // without the point after the PID
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const std::size_t at = name.rfind(start);
    if (!name.starts_with('.') || !name.ends_with(".tmp") || at == std::string::npos) continue;
    const int pid = std::atoi(name.c_str() + at + start.size());
    if (pid > 0 && kill(pid, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), ignored);
  }
}

}  // namespace

OutputFile::OutputFile(const fs::path& path) : given_(path), place_(behind_links(path)) {
  require_replaceable(given_, place_);
  const SignalsWait until_listed;
  std::string stem(".");
  stem.append(place_.filename().string()).append(process_mark(std::to_string(getpid())));
  remove_abandoned(place_.parent_path());
  for (int attempt = 0; attempt < 1000; ++attempt) {
    unfinished_ = place_.parent_path() / (stem + std::to_string(attempt) + ".tmp");
    const Descriptor file(open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() >= 0) {
      on_signal_.emplace(unfinished_, Unfinished::Kind::file);
      return;
    }
    if (errno != EEXIST) fail(given_, errno);
  }
  fail(given_, EEXIST);
}

OutputFile::~OutputFile() {
  if (!moved_) unlink(unfinished_.c_str());
}

void OutputFile::write(std::span<const std::byte> bytes) {
  Descriptor file(open(unfinished_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (file.get() < 0) fail(given_, errno);
  while (!bytes.empty()) {
    const ssize_t written =
        ::write(file.get(), bytes.data(), std::min<std::size_t>(bytes.size(), std::size_t{1} << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(given_, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  if (!file.close()) fail(given_, errno);
}

void OutputFile::move_into_place() {
  Descriptor file(open(unfinished_.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail(given_, errno);
  if (const std::optional<struct stat> old = status_of(place_)) {
    require_replaceable(given_, place_);
    const std::optional<struct stat> own = status_of(unfinished_);
    const bool same_owner = own && own->st_uid == old->st_uid && own->st_gid == old->st_gid;
    if (!same_owner && fchown(file.get(), old->st_uid, old->st_gid) != 0) {
      fail(given_,
           "the existing output file belongs to another user, and tumble cannot keep its owner; choose another output "
           "name");
    }
    if (fchmod(file.get(), old->st_mode & 07777) != 0) fail(given_, errno);
  }
  // Some file systems report a full disk only at flush or close.
  if (fsync(file.get()) != 0 || !file.close()) fail(given_, errno);
  if (rename(unfinished_.c_str(), place_.c_str()) != 0) fail(given_, errno);
  moved_ = true;
  on_signal_.reset();
}

OutputFolder::OutputFolder(const fs::path& folder) : folder_(folder) {
  const SignalsWait until_listed;
  std::error_code error;
  made_ = fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) fail(folder, error.message());
  remove_abandoned(folder);
  const bool empty = fs::is_empty(folder, error);
  if (error) fail(folder, error.message());
  if (!empty) {
    throw BadInput(fmt::format(
        "{}: the output folder contains files, which would mix with the files of this run; choose a new folder or "
        "empty this folder",
        folder.string()));
  }
  on_signal_.emplace(folder, made_ ? Unfinished::Kind::folder : Unfinished::Kind::contents);
}

OutputFolder::~OutputFolder() {
  if (kept_) return;
  std::error_code ignored;
  if (made_) {
    fs::remove_all(folder_, ignored);
    return;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, ignored)) {
    fs::remove_all(entry.path(), ignored);
  }
}

void replace_file(const fs::path& path, std::span<const std::byte> bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.move_into_place();
}

void replace_file(const fs::path& path, std::string_view text) {
  replace_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void require_not_an_input(const fs::path& output, std::span<const fs::path> inputs) {
  require_outside(output, inputs);
  const std::optional<struct stat> own = status_of(output);
  if (!own) return;
  if (!S_ISREG(own->st_mode) && !S_ISDIR(own->st_mode)) require_replaceable(output, output);
  for (const fs::path& input : inputs) {
    const std::optional<struct stat> other = input.empty() ? std::nullopt : status_of(input);
    if (other && other->st_dev == own->st_dev && other->st_ino == own->st_ino) {
      throw BadInput(fmt::format("{}: the file is both input and output; choose another output name", output.string()));
    }
  }
}

}  // namespace tumble::scenarios
