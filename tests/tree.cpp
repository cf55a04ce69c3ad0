// SPDX-License-Identifier: BSD-3-Clause
#include "tests/tree.hpp"

#include <cstdlib>

namespace tumble::test {

std::filesystem::path source_dir() {
  return TUMBLE_SOURCE_DIR;
}

std::filesystem::path program() {
  return TUMBLE_PROGRAM;
}

std::filesystem::path certificates() {
  return program().parent_path().parent_path() / "Testing" / "cache";
}

std::filesystem::path shared_data() {
  const char* named = std::getenv("TUMBLE_SHARED_DATA");
  return named != nullptr ? named : TUMBLE_SHARED_DATA;
}

}  // namespace tumble::test
