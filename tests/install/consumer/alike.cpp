// SPDX-License-Identifier: BSD-3-Clause
// Must link only if its memory layout is that of the library.
#include <cstdio>
#include <tumble/common/status.hpp>

int main() {
  std::puts(tumble::to_string(tumble::ErrorCode::none));
}
