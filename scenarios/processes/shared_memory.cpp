// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/processes/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace tumble::scenarios {

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

SharedMemory::SharedMemory(const char* name) : descriptor_(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (descriptor_ < 0) fail("memfd_create");
}

SharedMemory::~SharedMemory() {
  close(descriptor_);
}

void SharedMemory::append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("shared memory");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void SharedMemory::seal() {
  if (fcntl(descriptor_, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL) != 0)
    fail("shared memory");
}

std::size_t SharedMemory::size() const {
  struct stat about {};
  if (fstat(descriptor_, &about) != 0) fail("shared memory");
  return static_cast<std::size_t>(about.st_size);
}

std::string SharedMemory::contents() const {
  std::string out(size(), '\0');
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t count = pread(descriptor_, out.data() + done, out.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("shared memory");
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  out.resize(done);
  return out;
}

}  // namespace tumble::scenarios
