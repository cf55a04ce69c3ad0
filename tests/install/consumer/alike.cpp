// SPDX-License-Identifier: BSD-3-Clause
// Links where it lays out memory as the library does, and nowhere else.
#include <cstdio>
#include <tumble/common/status.hpp>

int main() {
  std::puts(tumble::to_string(tumble::ErrorCode::none));
}
