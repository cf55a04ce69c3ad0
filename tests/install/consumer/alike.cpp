// SPDX-License-Identifier: BSD-3-Clause
// Links only if the memory layout equals that of the library.
#include <cstdio>
#include <tumble/common/status.hpp>

int main() {
  std::puts(tumble::to_string(tumble::ErrorCode::none));
}
