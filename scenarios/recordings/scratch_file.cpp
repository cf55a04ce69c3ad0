// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/scratch_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

[[noreturn]] void fail(const std::filesystem::path& folder, const char* what, int error) {
  throw BadInput(folder.string() + ": " + what + ": " + std::generic_category().message(error));
}

}  // namespace

std::filesystem::path scratch_folder_of(const std::filesystem::path& output) {
  std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
  while (folder.has_relative_path() && !std::filesystem::is_directory(folder)) folder = folder.parent_path();
  return folder;
}

ScratchFile::ScratchFile(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) folder_ = ".";
  descriptor_ = open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ >= 0) return;
  std::string name = (folder_ / ".tumble_scratch.XXXXXX").string();
  descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail(folder_, "cannot create a file in the folder for temporary files", errno);
  unlink(name.c_str());
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ScratchFile::write(std::uint64_t at, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(folder_, "cannot write to a file in the folder for temporary files", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    at += static_cast<std::uint64_t>(written);
    bytes_ = std::max(bytes_, at);
  }
}

void ScratchFile::read(std::uint64_t at, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail(folder_, "cannot read a file in the folder for temporary files", got < 0 ? errno : EIO);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    at += static_cast<std::uint64_t>(got);
  }
}

ScratchFolder::ScratchFolder(const std::string& use) {
  const SignalsWait until_listed;
  std::string name = (std::filesystem::temp_directory_path() / ("tumble-" + use + "-XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::filesystem::filesystem_error("cannot create a temporary folder", name, {errno, std::generic_category()});
  path_ = name;
  on_signal_.emplace(path_, Unfinished::Kind::folder);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tumble::scenarios
