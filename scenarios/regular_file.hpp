// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

/// Throws BadInput if the input is not readable as a file. Pipes are accepted, because the caller reads the input once,
/// from beginning to end.
inline std::filesystem::file_status require_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status found = std::filesystem::status(path, error);
  if (found.type() == std::filesystem::file_type::not_found) throw BadInput(path.string() + ": no such file");
  if (error) throw BadInput(path.string() + ": cannot be read: " + error.message());
  if (std::filesystem::is_directory(found)) throw BadInput(path.string() + ": is a folder; it must be a file");
  return found;
}

/// Checks that the input is a regular file before the input is opened, because opening a pipe without a writer blocks
/// for ever, and devices have no end.
inline void require_regular_file(const std::filesystem::path& path) {
  switch (require_file(path).type()) {
    case std::filesystem::file_type::regular:
      return;
    case std::filesystem::file_type::fifo:
      throw BadInput(path.string() + ": is a pipe; it must be a regular file");
    case std::filesystem::file_type::socket:
      throw BadInput(path.string() + ": is a socket; it must be a regular file");
    default:
      throw BadInput(path.string() + ": is a device; it must be a regular file");
  }
}

inline std::ifstream open_regular_file(const std::filesystem::path& path) {
  require_regular_file(path);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw BadInput(path.string() + ": cannot be read" + (errno ? std::string(": ") + std::strerror(errno) : ""));
  return stream;
}

}  // namespace tumble::scenarios
